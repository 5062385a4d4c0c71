#pragma once

namespace manoscope::inversion {

/// How a wall is fitted to the calibration, and p(x) read through it.
struct ReadNonlocalOptions {
  bool nonlocal = true;  ///< off: every station on its own
  /// Finest ripple of p(x) that is looked for away from the ends, as a share of the wavelength of
  /// which the wall itself shows half.
  double finest_ripple = 1.0;
  /// A wall model whose profiles near the ends are off by more than this share is not used.
  double largest_model_error = 0.2;

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("nonlocal", nonlocal,
          "read p(x) through the influence operator of a wall fitted to the calibration");
    visit("finest-ripple", finest_ripple,
          "finest ripple of p(x) looked for, as a share of the wall's half-response wavelength");
    visit("largest-model-error", largest_model_error,
          "largest relative misfit of the wall model near the ends");
  }
  /// @throws InputError naming the option out of range.
  void validate() const;
};

}  // namespace manoscope::inversion
