// Modes measured from a recording of an object. Pure.
#pragma once

#include <tactus/material_def_t.hpp>

#include "audio_node/modal/body_sound.h"
#include "audio_node/settings.gen.h"

namespace tactus::audio {

// Replaces the modes of a body by the measured modes of its material; nothing happens if there are none. The
// strongest has gain 1. All keep their recorded strength, independent of the struck place. If there are more than
// settings.max_modes, the strongest are kept.
void apply_measured_modes(BodySound& sound, const material_def_t& material, const Settings& settings);

}  // namespace tactus::audio
