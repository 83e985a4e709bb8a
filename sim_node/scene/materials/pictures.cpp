#include "sim_node/scene/materials/pictures.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tactus/asset_ref_t.hpp>

#include "sim_node/scene/materials/height_image.h"
#include "sync/bus/identity.h"

namespace tactus::sim {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPng{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

std::size_t big_endian(Bytes bytes, std::size_t at, std::size_t count) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}

void check_sides(std::size_t columns, std::size_t rows) {
  const auto fits = [](std::size_t side) {
    return side >= 1 && side <= static_cast<std::size_t>(kMaxPictureSide);
  };
  if (!fits(columns) || !fits(rows))
    throw std::runtime_error("it must have 1 to " + std::to_string(kMaxPictureSide) + " pixels per side");
}

// Walks all chunks (ISO/IEC 15948, 5.3).
void check_png(Bytes bytes) {
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t size = big_endian(bytes, at, 4), kind = big_endian(bytes, at + 4, 4);
    if (size > bytes.size() - at - 12) break;
    if (at == 8) {
      if (kind != 0x49484452 || size != 13) throw std::runtime_error("its first chunk is not a header");  // IHDR
      check_sides(big_endian(bytes, at + 8, 4), big_endian(bytes, at + 12, 4));
    }
    if (kind == 0x49454e44) return;  // IEND
    at += 12 + size;
  }
  throw std::runtime_error("it is truncated");
}

// Walks the markers up to the start of frame (ITU-T T.81, B.1.1.3 and B.2.2).
void check_jpeg(Bytes bytes) {
  for (std::size_t at = 2; at + 9 <= bytes.size();) {
    const std::uint8_t marker = bytes[at + 1];
    if (bytes[at] != 0xff) break;
    if (marker == 0xff) {  // a fill byte
      ++at;
      continue;
    }
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) return check_sides(big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2));
    at += 2 + big_endian(bytes, at + 2, 2);
  }
  throw std::runtime_error("it is truncated");
}

}  // namespace

void check_picture(Bytes bytes, PictureUse use) {
  if (bytes.size() >= 8 && std::equal(kPng.begin(), kPng.end(), bytes.begin())) return check_png(bytes);
  const bool jpeg = bytes.size() >= 4 && bytes[0] == 0xff && bytes[1] == 0xd8;
  if (jpeg && use == PictureUse::kColour) return check_jpeg(bytes);
  // JPEG compression distorts directions.
  throw std::runtime_error(use == PictureUse::kColour ? "it is neither PNG nor JPEG" : "it is not a PNG file");
}

std::int64_t add_image(WorldDef& world, sync::Asset image) {
  const std::int64_t hash = sync::fnv1a_64(image.bytes.data(), image.bytes.size());
  const auto same = [&](const sync::Asset& other) { return other.bytes == image.bytes; };
  if (std::none_of(world.images.begin(), world.images.end(), same)) world.images.push_back(std::move(image));
  return hash;
}

std::int64_t picture_of(LoadContext& context, const sdf::Element& element, const std::string& what,
                        const std::string& uri, PictureUse use) {
  const std::filesystem::path file = context.asset_file(uri, element);
  const auto [at, is_new] =
      context.picture_of_file.try_emplace(file.string() + (use == PictureUse::kColour ? "|colour" : "|directions"), 0);
  if (!is_new) return at->second;
  try {
    sync::Asset image{asset_ref_t::IMAGE, file.filename().string(), read_image_file(file)};
    check_picture(image.bytes, use);
    return at->second = add_image(context.world, std::move(image));
  } catch (const std::exception& e) {
    context.reject(element, "names " + what + " \"" + uri + "\", which cannot be read: " + e.what());
  }
}

}  // namespace tactus::sim
