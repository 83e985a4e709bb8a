// Where two bodies touch they flatten: how large that patch is, and what it smooths. Pure.
#pragma once

#include "audio_node/modal/modal.h"

namespace tactus::audio {

// E*: 1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b (Johnson, Contact Mechanics, 1985, eq. 3.36).
double reduced_modulus_Pa(const Elastic& a, const Elastic& b);

// Radius of the patch of a ball of that curvature under a force: (3 F R / (4 E*))^(1/3) (Hertz 1882; Johnson,
// eq. 4.22).
double patch_radius_m(double force_N, double curvature_1_m, double reduced_modulus_Pa);

// A patch that rolls over a profile feels its mean over the patch: of waves shorter than the patch is wide little
// is left. Frequency from which on at that speed (FoleyAutomatic, section 4.2, has a low-pass there whose cut-off
// is set by ear).
double patch_cutoff_Hz(double speed_m_s, double patch_radius_m);

// Newtons for a slope of 1 that a profile pushes what rolls over it with: by its waves as long as the patch is
// wide, of height 2 a / (2 pi), on the patch as a spring of 2 E* a (Johnson, eq. 4.23), which is 2 E* a^2 / pi. A
// body that is light or slow follows them instead: below the resonance of that spring with the mass its inertia is
// the force, which is less by the square of the frequency over the resonance.
double rolling_force_N(double patch_radius_m, double reduced_modulus_Pa, double effective_mass_kg,
                       double speed_m_s);

}  // namespace tactus::audio
