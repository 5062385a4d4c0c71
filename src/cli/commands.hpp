#pragma once

#include "command_line.hpp"

namespace manoscope::cli {

void add_check(Program& program);
void add_convert(Program& program);
void add_demo(Program& program);
void add_formats(Program& program);
void add_init(Program& program);
void add_inspect(Program& program);
void add_judge(Program& program);
void add_measure(Program& program);
void add_plan(Program& program);
void add_predict(Program& program);
void add_report(Program& program);
void add_serve(Program& program);
void add_simulate(Program& program);
void add_twin(Program& program);

}  // namespace manoscope::cli
