// A body that sounds as a recording of such an object did. Pure.
#pragma once

#include <tactus/material_def_t.hpp>

#include "audio_node/modal/body_sound.h"
#include "audio_node/settings.gen.h"

namespace tactus::audio {

// Replaces the modes of a body by those that its material was measured to have; nothing happens where it has none.
// The strongest has gain 1; all are heard as strong as they were recorded, and wherever the body is struck. Of
// more than settings.max_modes the strongest stay.
void sound_as_measured(BodySound& sound, const material_def_t& material, const Settings& settings);

}  // namespace tactus::audio
