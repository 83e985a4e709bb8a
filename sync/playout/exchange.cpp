#include "sync/playout/exchange.h"

#include <fstream>
#include <iterator>
#include <vector>

#include "sync/decode.h"

namespace tactus::sync {
namespace {
constexpr const char* kFile = "playout.request";
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

void keep_request(const std::filesystem::path& folder, const playout_request_t& request) {
  const std::vector<std::uint8_t> bytes = encode(request);
  std::ofstream(folder / kFile, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::optional<playout_request_t> kept_request(const std::filesystem::path& folder, std::int64_t run_id) {
  std::ifstream file(folder / kFile, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  const auto request = decode<playout_request_t>(bytes.data(), bytes.size());
  return request && request->header.run_id == run_id ? request : std::nullopt;
}

}  // namespace tactus::sync
