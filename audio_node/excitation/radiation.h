// Sound that an oscillating or suddenly accelerated ball radiates: the model of every body as a source. Pure.
#pragma once

namespace tactus::audio {

// Air at 20 degrees Celsius (Kinsler et al., Fundamentals of Acoustics, 4th ed., appendix A10).
inline constexpr double kAirDensity_kg_m3 = 1.21, kSoundSpeed_m_s = 343;

// Pressure amplitude at 1 m ahead of an oscillating ball of radius a, over rho c times the amplitude of its velocity:
// a (ka)^2 / sqrt(4 + (ka)^4), m, k = 2 pi f / c (dipole field with the velocity of the ball as boundary condition; Pierce,
// Acoustics, 1981, section 4.2).
double radiation_m(double frequency_Hz, double radius_m);

// Peak pressure, Pa, at 1 m ahead of a ball of radius a whose velocity changes by `velocity_m_s` within `length_s` under a raised
// cosine of force (acceleration noise; Koss and Alfredson, J. Sound Vib. 27, 1973, p. 59). The field of radiation_m() as a
// function of time: p(t) = rho c a times the convolution of the acceleration with e^(-x) (cos x - sin x), x = c t / a. Short
// against a / c it tends to rho c a v; long it tends to rho a^3 2 pi v / (2 c T^2), the jerk of a small source. Rises with
// velocity and radius and falls with length. Zero for a velocity, length or radius that is not positive.
double acceleration_peak_Pa(double velocity_m_s, double length_s, double radius_m);

}  // namespace tactus::audio
