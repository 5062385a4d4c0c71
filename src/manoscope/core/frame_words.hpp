#pragma once

#include "manoscope/core/frame.hpp"
#include "manoscope/core/words.hpp"

namespace manoscope {

/// How the experiment and scenario files write where a channel lies in a map.
inline constexpr Word<FlowDirection> kFlowDirections[] = {
    {"+columns", FlowDirection::plus_columns},
    {"-columns", FlowDirection::minus_columns},
    {"+rows", FlowDirection::plus_rows},
    {"-rows", FlowDirection::minus_rows}};
inline constexpr Word<Outward> kOutwards[] = {{"+height", Outward::plus_height},
                                              {"-height", Outward::minus_height}};

}  // namespace manoscope
