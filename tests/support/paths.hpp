#pragma once

// Places on this machine that tests need. Their values come with the build and live in
// test_main.cpp alone, so that every other object is the same wherever the sources lie.

namespace manoscope::test_paths {

extern const char* const shared;   ///< folder of shared practice data; may be absent
extern const char* const source;   ///< root of the sources
extern const char* const python;   ///< Python interpreter
extern const char* const program;  ///< the built `manoscope`

}  // namespace manoscope::test_paths
