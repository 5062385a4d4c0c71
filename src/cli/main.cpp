// manoscope: the command line. Each command is a file of its own.
#include "commands.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // Maps come and go by the megabyte: handing each back to the system and asking for it again would
  // cost a quarter of the time of a reduction.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
  manoscope::cli::Program program;
  manoscope::cli::add_demo(program);
  manoscope::cli::add_init(program);
  manoscope::cli::add_check(program);
  manoscope::cli::add_inspect(program);
  manoscope::cli::add_convert(program);
  manoscope::cli::add_formats(program);
  manoscope::cli::add_measure(program);
  manoscope::cli::add_predict(program);
  manoscope::cli::add_simulate(program);
  manoscope::cli::add_plan(program);
  manoscope::cli::add_twin(program);
  manoscope::cli::add_judge(program);
  manoscope::cli::add_report(program);
  manoscope::cli::add_serve(program);
  return program.run(argc, argv);
}
