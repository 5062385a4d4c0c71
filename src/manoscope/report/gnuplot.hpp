#pragma once

#include <optional>
#include <string>

namespace manoscope::report {

/// What gnuplot made of a script.
struct GnuplotOutput {
  bool succeeded = false;
  std::string bytes;     ///< what it wrote to standard output
  std::string messages;  ///< what it wrote to standard error
};

/// Runs a script in gnuplot, a separate process started without a shell, without the user's
/// start-up files and in a fixed locale, so that the same script gives the same bytes. A process
/// that stays silent for a minute is stopped.
///
/// Scripts must hold no text of the user: gnuplot can run commands.
/// @return nullopt where gnuplot is not installed.
/// @throws InternalError if the process cannot be started for another reason.
std::optional<GnuplotOutput> run_gnuplot(const std::string& script);

}  // namespace manoscope::report
