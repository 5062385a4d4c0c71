#include "manoscope/core/cross_sections.hpp"

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope {

CrossSections mean_sections(const std::vector<CrossSections>& repeats) {
  CrossSections mean;
  Array2 count, variance;
  double n = 0.0;
  for (const CrossSections& one : repeats) {
    if (one.empty()) continue;
    if (n == 0.0) {
      mean = {Array1::Zero(one.x.size()),
              one.z,
              Array2::Zero(one.zeta.rows(), one.zeta.cols()),
              {},
              {}};
      count = variance = mean.zeta;
    }
    MANO_ASSERT(one.x.size() == mean.x.size() && one.z.size() == mean.z.size());
    const Array2 good = (one.flags == 0).cast<double>();
    mean.x += one.x;
    mean.zeta += good * one.zeta;
    variance += good * one.sigma.square();
    count += good;
    n += 1.0;
  }
  if (n == 0.0) return mean;
  const Array2 weight = (count > 0.0).select(count.max(1.0).inverse(), 0.0);
  mean.x /= n;
  mean.zeta *= weight;
  mean.sigma = variance.sqrt() * weight;
  mean.flags = (count > 0.0)
                   .select(Flags2::Zero(count.rows(), count.cols()),
                           Flags2::Constant(count.rows(), count.cols(), PixelFlag::no_data));
  return mean;
}

}  // namespace manoscope
