// Tests of profiles on the bus: pages, generations and the copy on disk.
#include "sync/degradation/profile_exchange.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <limits>
#include <tactus/degradation_t.hpp>

#include "sync/bus/identity.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

// The number of remarks sets the length of the profile.
std::string profile(int remarks) {
  std::string text = "<profile><degrade modality=\"audio\" delay=\"40ms\"/>";
  for (int i = 0; i < remarks; ++i)
    text += "<!-- remark number " + std::to_string(i) + ", of no meaning to anyone -->";
  return text + "</profile>";
}

std::vector<degradation_t> pages(const std::string& text, std::int64_t generation) {
  constexpr std::size_t kPage = 1200;
  std::vector<degradation_t> out;
  for (std::size_t at = 0; at < text.size(); at += kPage) {
    degradation_t m{};
    m.generation = generation;
    m.start_sim_ns = 5;
    m.hash = fnv1a_64(text.data(), text.size());
    m.size = static_cast<std::int32_t>(text.size());
    m.page = static_cast<std::int32_t>(out.size());
    m.text = text.substr(at, kPage);
    out.push_back(m);
  }
  for (degradation_t& m : out) m.pages = static_cast<std::int32_t>(out.size());
  return out;
}

std::optional<ProfileInForce> take_all(ProfileReceiver& r, const std::vector<degradation_t>& messages) {
  std::optional<ProfileInForce> whole;
  for (const degradation_t& m : messages)
    if (auto w = r.push(m)) whole = std::move(w);
  return whole;
}

struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("tactus_profile_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
};

}  // namespace

TEST_CASE("A profile of many pages is assembled in any order, and only a newer one replaces it") {
  ProfileReceiver r;
  auto messages = pages(profile(100), 3);
  REQUIRE(messages.size() > 3);
  std::swap(messages[0], messages[2]);
  messages.insert(messages.begin(), messages[1]);
  const auto whole = take_all(r, messages);
  REQUIRE(whole);
  CHECK(whole->text == profile(100));
  CHECK(whole->generation == 3);
  CHECK(whole->start == sim_time(5));
  CHECK_FALSE(take_all(r, messages));
  CHECK_FALSE(take_all(r, pages(profile(1), 2)));
  CHECK(take_all(r, pages(profile(100), 4)));  // the same text, requested again
}

TEST_CASE("An invalid profile is rejected as a whole and does not block a valid one") {
  ProfileReceiver r;
  CHECK_FALSE(take_all(r, pages("<profile><degrade modality=\"audio\" delay=\"-40ms\"/></profile>", 7)));
  CHECK(r.generation() == -1);
  CHECK_FALSE(r.take_refusal().empty());
  CHECK(r.take_refusal().empty());
  CHECK(take_all(r, pages(profile(1), 5)));
}

TEST_CASE("A page of an incomplete profile does not block other profiles") {
  ProfileReceiver r;
  degradation_t forged = pages(profile(100), std::numeric_limits<std::int64_t>::max()).front();
  CHECK_FALSE(r.push(forged));
  auto messages = pages(profile(80), 9);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto whole = r.push(messages[i]);
    CHECK(whole.has_value() == (i + 1 == messages.size()));
    forged.hash += 1;
    if (i % 2 == 0) CHECK_FALSE(r.push(forged));
  }
}

TEST_CASE("The active profile is stored for a restart within the same run") {
  const Folder folder;
  CHECK_FALSE(load_profile(folder.path, 4));
  const std::string text = profile(3);
  const ProfileInForce p{text, fnv1a_64(text.data(), text.size()), 12, sim_time(34), {}};
  store_profile(folder.path, p, 4);
  const auto kept = load_profile(folder.path, 4);
  REQUIRE(kept);
  CHECK(kept->text == text);
  CHECK(kept->hash == p.hash);
  CHECK(kept->generation == 12);
  CHECK(kept->start == sim_time(34));
  CHECK_FALSE(load_profile(folder.path, 5));
  std::ofstream(folder.path / "profile.in_force", std::ios::app) << " ";
  CHECK_FALSE(load_profile(folder.path, 4));
}
