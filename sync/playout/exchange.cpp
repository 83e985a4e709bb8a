#include "sync/playout/exchange.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <tactus/playout_entry_t.hpp>
#include <utility>
#include <vector>

#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"

namespace tactus::sync {
namespace {
constexpr const char* kFile = "playout.request";
constexpr int kMaxMessageBytes = static_cast<int>(channels::kMaxMessageBytes);
}

playout_request_t request_for(const PlayoutPlan& plan, std::int64_t generation) {
  playout_request_t m{};
  write_plan(m, generation, plan);
  for (const auto& [name, asynchrony] : plan.soa) {
    playout_entry_t e{};
    e.modality = name;
    e.soa_ns = asynchrony.count();
    e.needs_ns = -1;
    m.entries.push_back(std::move(e));
  }
  m.count = static_cast<std::int32_t>(m.entries.size());
  return m;
}

std::vector<playout_t> pages_of(const playout_t& whole) {
  std::vector<playout_entry_t> entries = whole.entries;
  std::stable_partition(entries.begin(), entries.end(), [](const playout_entry_t& e) { return e.soa_ns != 0; });
  std::vector<playout_t> pages;
  for (playout_entry_t& e : entries) {
    if (pages.empty() || pages.back().getEncodedSize() + e._getEncodedSizeNoHash() > kMaxMessageBytes) {
      pages.push_back(whole);
      pages.back().entries.clear();
      pages.back().count = 0;
    }
    pages.back().entries.push_back(std::move(e));
    ++pages.back().count;
  }
  if (pages.empty()) pages.push_back(whole);
  return pages;
}

void add_page(playout_t& whole, const playout_t& page) {
  if (page.generation < whole.generation) return;
  if (page.generation > whole.generation) whole.entries.clear();
  std::vector<playout_entry_t> entries = std::move(whole.entries);
  for (const playout_entry_t& e : page.entries) {
    const auto same = std::ranges::find_if(entries, [&](const playout_entry_t& known) { return known.modality == e.modality; });
    if (same == entries.end())
      entries.push_back(e);
    else
      *same = e;
  }
  whole = page;
  whole.entries = std::move(entries);
  whole.count = static_cast<std::int32_t>(whole.entries.size());
}

void store_request(const std::filesystem::path& folder, const playout_request_t& request) {
  const std::vector<std::uint8_t> bytes = encode(request);
  std::ofstream(folder / kFile, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::optional<playout_request_t> load_request(const std::filesystem::path& folder, std::int64_t run_id) {
  std::ifstream file(folder / kFile, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  const auto request = decode<playout_request_t>(bytes.data(), bytes.size());
  return request && request->header.run_id == run_id ? request : std::nullopt;
}

}  // namespace tactus::sync
