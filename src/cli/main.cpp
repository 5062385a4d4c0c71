// manoscope: the command line. Each command is a file of its own.
#include "commands.hpp"

int main(int argc, char** argv) {
  manoscope::cli::Program program;
  manoscope::cli::add_demo(program);
  manoscope::cli::add_init(program);
  manoscope::cli::add_check(program);
  manoscope::cli::add_inspect(program);
  manoscope::cli::add_convert(program);
  manoscope::cli::add_formats(program);
  manoscope::cli::add_measure(program);
  manoscope::cli::add_judge(program);
  manoscope::cli::add_report(program);
  return program.run(argc, argv);
}
