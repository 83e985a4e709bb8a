// Pictures of a scene or mesh: colour maps, normal maps and environments.
#pragma once

#include <span>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

enum class PictureUse { kColour, kDirections };

// Per side, the limit of visual_node: 64 MiB there (design).
constexpr int kMaxPictureSide = 4096;

// Throws std::runtime_error with one clause unless the bytes are a complete PNG, or for colour a JPEG, of 1 to
// kMaxPictureSide pixels per side. Does not decode the pixels.
void check_picture(std::span<const std::uint8_t> bytes, PictureUse use);

// Adds the picture to the images of the world unless it is among them; returns its hash.
std::int64_t add_image(WorldDef& world, sync::Asset image);

// The same for a file that an element names; rejects a missing file and an invalid picture.
std::int64_t picture_of(LoadContext& context, const sdf::Element& element, const std::string& what,
                        const std::string& uri, PictureUse use);

}  // namespace tactus::sim
