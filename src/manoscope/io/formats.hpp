#pragma once

#include "manoscope/io/reader.hpp"

namespace manoscope::io {

// One reader a format, each defined in the file of that format; registry.cpp lists them.
const Reader& gsf_reader();
const Reader& netcdf_reader();
const Reader& text_reader();

}  // namespace manoscope::io
