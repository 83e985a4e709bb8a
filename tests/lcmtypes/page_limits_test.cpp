// Tests of the largest number of pages: a message with more never enters a program.
#include "lcmtypes/page_limits.h"

#include <catch2/catch.hpp>
#include <climits>

#include "sync/bus/decode.h"
#include "tests/lcmtypes/all_messages.h"
#include "tests/lcmtypes/samples.h"

namespace tactus::test {
namespace {

constexpr int max_pages(const contact_events_t&) { return kMaxEventPages; }
constexpr int max_pages(const contact_frame_t&) { return kMaxContactPages; }
constexpr int max_pages(const world_state_t&) { return kMaxWorldPages; }
constexpr int max_pages(const sync_report_t&) { return kMaxReportPages; }
constexpr int max_pages(const degradation_t&) { return kMaxProfilePages; }
constexpr int max_pages(const scene_manifest_t&) { return kMaxManifestPages; }
constexpr int max_pages(const asset_chunk_t&) { return kMaxAssetChunks; }
constexpr int max_pages(const picture_chunk_t&) { return kMaxPictureChunks; }

template <class Message>
void set_pages(Message& m, int page, int pages) {
  if constexpr (requires { m.pages; })
    m.page = page, m.pages = pages;
  else
    m.chunk = page, m.chunks = pages;
}

}  // namespace

TEMPLATE_TEST_CASE("A message with more pages than its kind can have is refused", "", contact_events_t, contact_frame_t, world_state_t,
                   sync_report_t, degradation_t, scene_manifest_t, asset_chunk_t, picture_chunk_t) {
  Samples samples(4);
  TestType m{};
  samples.fill(m);
  const int most = max_pages(m);
  const auto accepted = [&](int page, int pages) {
    set_pages(m, page, pages);
    const auto bytes = sync::encode(m);
    return sync::decode_asset<TestType>(bytes).has_value();
  };
  CHECK(accepted(0, most));
  CHECK(accepted(most - 1, most));
  CHECK_FALSE(accepted(0, most + 1));
  CHECK_FALSE(accepted(most, most + 1));
  for (const int page : {0, 1, 1 << 20, INT_MAX - 1}) CHECK_FALSE(accepted(page, INT_MAX));
}

}  // namespace tactus::test
