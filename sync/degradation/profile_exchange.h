// Carries a profile over the bus: its XML, in pages. The newest holds; sync_node repeats it for those who come late, and
// nobody needs sync_node to change it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tactus/degradation_t.hpp>

#include "sync/degradation/profile.h"

namespace tactus::sync {

class Bus;

// A profile that is in force, and since when.
struct ProfileInForce {
  std::string text;  // XML
  std::int64_t hash = 0;
  std::int64_t generation = 0;  // larger is newer
  SimTime start{};
};

// Longest profile, bytes.
inline constexpr std::size_t kMaxProfileBytes = 65536;

// Sends all pages. The text must not be longer than kMaxProfileBytes.
void send_profile(Bus& bus, const ProfileInForce& profile);

// Puts the pages together. Pure.
class ProfileReceiver {
 public:
  // The profile, when this page has made one whole that is newer than the one before. Pages of a text whose hash does not
  // fit are forgotten.
  std::optional<ProfileInForce> take(const degradation_t& page);
  // What holds already, from a file or a scene: only newer ones are taken.
  void set_generation(std::int64_t generation) { generation_ = generation; }
  // Of the newest; -1: none yet.
  std::int64_t generation() const { return generation_; }

 private:
  std::int64_t generation_ = -1;
  std::int64_t partial_generation_ = -1;
  std::map<int, std::string> pages_;
};

// The XML of a file. Throws std::invalid_argument with one sentence when it cannot be read, is too long or is no profile.
std::string read_profile_file(const std::string& path);

}  // namespace tactus::sync
