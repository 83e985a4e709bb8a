// Roughness of a material without a map: the heights of its usual finish. Pure.
#pragma once

#include "audio_node/modal/modal.h"

namespace tactus::audio {

// Root mean square height, m, of waves up to 0.8 mm (the cutoff of ISO 4288 for surfaces of 0.1 to 2 um), of the
// known material whose stiffness and density are nearest: materials of a scene have their own names and inherit
// the numbers.
double finish_m(const Elastic& material);

}  // namespace tactus::audio
