// The scaled complementary error function, erfcx(x) = exp(x^2) erfc(x), without overflow.
#pragma once

namespace tactus::thermal {

// Relative error below 1e-14. x >= 0 or NaN; 0 for infinity. Pure.
double erfcx(double x);

}  // namespace tactus::thermal
