// Carries a profile over the bus: its XML, in pages. The newest holds. sync_node repeats it for late joiners; a profile can
// be changed without sync_node.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <tactus/degradation_t.hpp>
#include <utility>

#include "lcmtypes/page_limits.h"
#include "sync/bus/page_assembler.h"
#include "sync/degradation/profile.h"

namespace tactus::sync {

class Bus;

// Longest profile, bytes.
inline constexpr std::size_t kMaxProfileBytes = 65536;

// Publishes all pages. The text must not be longer than kMaxProfileBytes.
void send_profile(Bus& bus, const ProfileInForce& profile);

// Stores the profile in force in a file: a restarted sync_node reads it from there.
void store_profile(const std::filesystem::path& folder, const ProfileInForce& profile, std::int64_t run_id);
// nullopt when there is no file, or when it is damaged or belongs to another run.
std::optional<ProfileInForce> load_profile(const std::filesystem::path& folder, std::int64_t run_id);

// Assembles the pages. Pure.
class ProfileReceiver {
 public:
  // Profiles that may be in flight at the same time; the one whose newest page is the oldest is discarded first.
  static constexpr std::size_t kMaxInFlight = 4;
  // Maximum number of pages of one profile.
  static constexpr int kMaxPages = kMaxProfilePages;

  // Returns the profile when this page completes one that is newer than the previous one. A text that does not match its
  // hash, or that is not a valid profile, is refused as a whole: nothing changes.
  std::optional<ProfileInForce> push(const degradation_t& page);
  // One sentence on the last profile with an invalid text; returned once, then empty.
  std::string take_refusal() { return std::exchange(refusal_, {}); }
  // The generation already in force, from a file or a scene: only newer ones are accepted.
  void set_generation(std::int64_t generation) { generation_ = generation; }
  // Generation of the newest profile; -1: none yet.
  std::int64_t generation() const { return generation_; }

 private:
  std::int64_t generation_ = -1;
  // Incomplete profiles by generation and hash.
  PageAssembler<std::string, std::pair<std::int64_t, std::int64_t>> pages_{{.groups = kMaxInFlight, .pages = kMaxPages},
                                                                           PageOrder::kNewestPage};
  std::string refusal_;
};

// Reads the profile of a file. Throws std::invalid_argument with one sentence when it cannot be read, is too long or is no
// valid profile.
ProfileInForce read_profile_file(const std::string& path);

}  // namespace tactus::sync
