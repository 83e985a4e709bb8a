// The contact patch of two bodies: its size and its smoothing effect. Pure.
#pragma once

#include "audio_node/modal/modal.h"

namespace tactus::audio {

// E*: 1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b (Johnson, Contact Mechanics, 1985, eq. 3.36).
double reduced_modulus_Pa(const Elastic& a, const Elastic& b);

// Radius of the patch of a ball of that curvature under a force: (3 F R / (4 E*))^(1/3) (Hertz 1882; Johnson, eq.
// 4.22).
double patch_radius_m(double force_N, double curvature_1_m, double reduced_modulus_Pa);

// A patch that rolls over a profile responds to the mean of the profile over the patch, which attenuates waves
// shorter than its width. Returns the cutoff frequency at that speed (FoleyAutomatic, section 4.2, has a low-pass
// there with a cutoff set by ear).
double patch_cutoff_Hz(double speed_m_s, double patch_radius_m);

// Force per unit slope of a profile on a rolling body, N. Waves as long as the patch is wide have the height 2 a /
// (2 pi) and act on the patch as a spring of 2 E* a (Johnson, eq. 4.23), which gives 2 E* a^2 / pi. A light or
// slow body follows the waves instead: below the resonance of that spring with the mass, its inertia is the force,
// which is lower by the square of frequency over resonance.
double rolling_force_N(double patch_radius_m, double reduced_modulus_Pa, double effective_mass_kg,
                       double speed_m_s);

}  // namespace tactus::audio
