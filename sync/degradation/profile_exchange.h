// Carries a profile over the bus: its XML, in pages. The newest holds; sync_node repeats it for those who come
// late, and nobody needs sync_node to change it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <tactus/degradation_t.hpp>
#include <utility>

#include "sync/bus/page_assembler.h"
#include "sync/degradation/profile.h"

namespace tactus::sync {

class Bus;

// Longest profile, bytes.
inline constexpr std::size_t kMaxProfileBytes = 65536;

// Sends all pages. The text must not be longer than kMaxProfileBytes.
void send_profile(Bus& bus, const ProfileInForce& profile);

// The profile in force, kept in a file: a sync_node that was killed comes back with it.
void keep_profile(const std::filesystem::path& folder, const ProfileInForce& profile, std::int64_t run_id);
// None when there is none, it is damaged, or it is of another run.
std::optional<ProfileInForce> kept_profile(const std::filesystem::path& folder, std::int64_t run_id);

// Puts the pages together. Pure.
class ProfileReceiver {
 public:
  // Profiles that may be on their way at once; the one whose newest page is the oldest is forgotten.
  static constexpr std::size_t kMaxOnTheirWay = 4;
  // Of one profile.
  static constexpr int kMaxPages = 55;

  // The profile, when this page has made one whole that is newer than the one before. One whose hash does not fit,
  // or that is no profile, is refused whole: nothing changes.
  std::optional<ProfileInForce> take(const degradation_t& page);
  // One sentence on the last that was refused for what it says; told once, then empty.
  std::string take_refusal() { return std::exchange(refusal_, {}); }
  // What holds already, from a file or a scene: only newer ones are taken.
  void set_generation(std::int64_t generation) { generation_ = generation; }
  // Of the newest; -1: none yet.
  std::int64_t generation() const { return generation_; }

 private:
  std::int64_t generation_ = -1;
  // By generation and hash.
  PageAssembler<std::string, std::pair<std::int64_t, std::int64_t>> pages_{{.groups = kMaxOnTheirWay, .pages = kMaxPages},
                                                                           PageOrder::kNewestPage};
  std::string refusal_;
};

// The profile of a file. Throws std::invalid_argument with one sentence when it cannot be read, is too long or is no
// profile.
ProfileInForce read_profile_file(const std::string& path);

}  // namespace tactus::sync
