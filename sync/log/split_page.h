// Splits the pages of a snapshot in two. Pure.
//
// The conversion of a log (upgrade_log.h) can make a page larger than a datagram. Every page of its type is then split: page k of n
// becomes the pages 2k and 2k + 1 of 2n, and the message s of its channel becomes the messages 2s and 2s + 1. Receivers
// assemble them as before.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::sync {

// The two halves of a page of CONTACTS, CONTACT_EVENTS or TOUCH_MODEL, by its fingerprint; the second one may be empty. Both
// fit a datagram if the page has at most 1.7 times its size and contacts of at most 4 points. nullopt: another type, damaged bytes, or too many
// pages to double their number.
std::optional<std::array<std::vector<std::uint8_t>, 2>> split_page(std::span<const std::uint8_t> message);

}  // namespace tactus::sync
