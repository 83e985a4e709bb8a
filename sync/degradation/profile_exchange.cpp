#include "sync/degradation/profile_exchange.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "sync/bus/bus.h"
#include "sync/bus/identity.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::sync {
namespace {
constexpr std::size_t kPageBytes = 1200;
static_assert(ProfileReceiver::kMaxPages == kMaxProfileBytes / kPageBytes + 1);
// Bounds the memory for a file that is then rejected as too long.
constexpr std::uintmax_t kMaxProfileFileBytes = 1 << 20;
constexpr const char* kFile = "profile.in_force";
constexpr const char* kFreshFile = "profile.in_force.new";
}  // namespace

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

std::optional<ProfileInForce> ProfileReceiver::push(const degradation_t& page) {
  if (page.generation <= generation_) return std::nullopt;
  const auto* pages = pages_.add({page.generation, page.hash}, page.page, page.pages, page.text);
  if (!pages) return std::nullopt;
  ProfileInForce whole{{}, page.hash, page.generation, sim_time(page.start_sim_ns), {}};
  for (const auto& [number, text] : pages->pages) whole.text += text;
  if (static_cast<int>(whole.text.size()) != page.size ||
      fnv1a_64(whole.text.data(), whole.text.size()) != page.hash)
    return std::nullopt;
  try {
    whole.parsed = std::make_shared<const Profile>(parse_profile(whole.text, "profile"));
  } catch (const std::invalid_argument& e) {
    refusal_ = e.what();
    return std::nullopt;
  }
  generation_ = page.generation;
  return whole;
}

void store_profile(const std::filesystem::path& folder, const ProfileInForce& p, std::int64_t run_id) {
  const std::filesystem::path file = folder / kFile, fresh = folder / kFreshFile;
  std::ofstream out(fresh, std::ios::binary | std::ios::trunc);
  out << run_id << " " << p.generation << " " << to_ns(p.start) << " " << p.hash << "\n" << p.text;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(fresh, file, error);
}

std::optional<ProfileInForce> load_profile(const std::filesystem::path& folder, std::int64_t run_id) {
  std::ifstream in(folder / kFile, std::ios::binary);
  std::int64_t run = 0, generation = 0, start_ns = 0, hash = 0;
  if (!(in >> run >> generation >> start_ns >> hash) || run != run_id || generation <= 0 || start_ns < 0) return std::nullopt;
  in.get();
  try {
    ProfileInForce p = read_profile({std::istreambuf_iterator<char>(in), {}}, "profile");
    if (p.hash != hash) return std::nullopt;
    p.generation = generation;
    p.start = sim_time(start_ns);
    return p;
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

ProfileInForce read_profile(std::string xml, const std::string& file) {
  ProfileInForce p;
  p.parsed = std::make_shared<const Profile>(parse_profile(xml, file));
  p.hash = fnv1a_64(xml.data(), xml.size());
  p.text = std::move(xml);
  return p;
}

ProfileInForce read_profile_file(const std::string& path) {
  std::string text;
  try {
    text = read_regular_text(path, kMaxProfileFileBytes);
  } catch (const std::runtime_error& e) {
    throw std::invalid_argument("the profile " + path + " cannot be read (" + e.what() +
                                "); give the path of an XML file");
  }
  if (text.size() > kMaxProfileBytes)
    throw std::invalid_argument("the profile " + path +
                                " is larger than 64 kB; remove parts that it does not need");
  return read_profile(std::move(text), path);
}

}  // namespace tactus::sync
