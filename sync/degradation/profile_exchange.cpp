#include "sync/degradation/profile_exchange.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "sync/bus.h"
#include "sync/identity.h"

namespace tactus::sync {
namespace {
constexpr std::size_t kPageBytes = 1200;
}

void send_profile(Bus& bus, const ProfileInForce& profile) {
  const std::size_t pages = std::max<std::size_t>(1, (profile.text.size() + kPageBytes - 1) / kPageBytes);
  for (std::size_t page = 0; page < pages; ++page) {
    degradation_t m{};
    m.header.sim_time_ns = -1;
    m.generation = profile.generation;
    m.start_sim_ns = to_ns(profile.start);
    m.hash = profile.hash;
    m.size = static_cast<std::int32_t>(profile.text.size());
    m.page = static_cast<std::int32_t>(page);
    m.pages = static_cast<std::int32_t>(pages);
    m.text = profile.text.substr(page * kPageBytes, kPageBytes);
    bus.publish(channels::kDegradation, m);
  }
}

std::optional<ProfileInForce> ProfileReceiver::take(const degradation_t& page) {
  if (page.generation <= generation_ || page.generation < partial_generation_) return std::nullopt;
  if (static_cast<std::size_t>(page.pages) > kMaxProfileBytes / kPageBytes + 1) return std::nullopt;
  if (page.generation > partial_generation_) pages_.clear();
  partial_generation_ = page.generation;
  pages_[page.page] = page.text;
  if (static_cast<int>(pages_.size()) < page.pages) return std::nullopt;
  ProfileInForce whole{{}, page.hash, page.generation, sim_time(page.start_sim_ns)};
  for (const auto& [number, text] : pages_) whole.text += text;
  pages_.clear();
  if (static_cast<int>(whole.text.size()) != page.size || fnv1a_64(whole.text.data(), whole.text.size()) != page.hash)
    return std::nullopt;
  generation_ = page.generation;
  return whole;
}

std::string read_profile_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  if (!file || !(text << file.rdbuf()))
    throw std::invalid_argument("the profile " + path + " cannot be read; give the path of an XML file");
  if (text.str().size() > kMaxProfileBytes)
    throw std::invalid_argument("the profile " + path + " is larger than 64 kB; leave out what it does not need");
  parse_profile(text.str(), path);
  return text.str();
}

}  // namespace tactus::sync
