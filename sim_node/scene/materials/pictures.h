// Pictures that a scene or a mesh names: colours, directions of normals, what lies around.
#pragma once

#include <span>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

enum class PictureUse { kColour, kDirections };

// Of each side, as visual_node takes them: 64 MiB there (design).
constexpr int kMaxPictureSide = 4096;

// Throws std::runtime_error with one clause when the bytes are no whole PNG, or where colour is meant JPEG, of 1
// to kMaxPictureSide pixels a side. The pixels themselves are for the renderer to read.
void check_picture(std::span<const std::uint8_t> bytes, PictureUse use);

// The hash of a picture, which becomes one of the world's images unless its bytes are among them already.
std::int64_t add_image(WorldDef& world, sync::Asset image);

// As that, of the file that an element names; refused when it is not there or is no such picture.
std::int64_t picture_of(LoadContext& context, const sdf::Element& element, const std::string& what,
                        const std::string& uri, PictureUse use);

}  // namespace tactus::sim
