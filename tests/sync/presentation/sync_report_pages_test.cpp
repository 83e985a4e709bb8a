// Tests of the pages of a sync report.
#include "sync/presentation/sync_report_pages.h"

#include <catch2/catch.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/sync_report_t.hpp>

#include "lcmtypes/channels.h"
#include "tests/sync/presentation/presentation_matcher_fixture.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

// `senses` modalities, each of which has presented one event.
void fill(MatcherFixture& f, int senses, std::size_t name_length = 12) {
  for (int i = 0; i < senses; ++i) {
    std::string name = "sense" + std::to_string(i);
    name.resize(std::max(name_length, name.size()), 'x');
    f.healths(name, name, kHit, 0, 3000);
    f.presented(name, name, 1, 1010 + i);
  }
  f.event(1, 1000);
  f.matcher.advance(f.at(2500));
}

std::vector<sync_report_t> published(const MatcherFixture& f, std::int64_t& seq) {
  auto pages = report_pages(f.matcher);
  for (sync_report_t& page : pages) page.header = header_of("sync_node", 5, seq++, 0);
  return pages;
}

}  // namespace

TEST_CASE("Report pages for any number of modalities fit a datagram and are complete together") {
  const int senses = GENERATE(0, 1, 4, 6, 12, 22);
  MatcherFixture f;
  fill(f, senses);
  std::int64_t seq = 0;
  const auto pages = published(f, seq);
  SyncReportReader reader;
  std::optional<sync_report_t> whole;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    CHECK(pages[i].getEncodedSize() <= static_cast<int>(channels::kMaxMessageBytes));
    CHECK(valid(pages[i]));
    CHECK(pages[i].hits == 1);
    CHECK_FALSE(whole);
    whole = reader.push(pages[i]);
  }
  REQUIRE(whole);
  CHECK(whole->modality_count == senses);
  CHECK(whole->pair_count == senses * (senses - 1) / 2);
  CHECK((senses <= 4) == (pages.size() == 1));
}

TEST_CASE("Only a name too long for a page is left out") {
  MatcherFixture f;
  fill(f, 2, 1500);
  f.healths("audio_node", "audio", kHit, 0, 3000);
  f.event(2, 1100);
  f.matcher.advance(f.at(3000));
  std::int64_t seq = 0;
  const auto pages = published(f, seq);
  REQUIRE(pages.size() == 1);
  CHECK(pages[0].modality_count == 1);
}

TEST_CASE("Pages of two reports are never mixed, also if pages are lost or overtaken") {
  MatcherFixture f;
  fill(f, 12);
  std::int64_t seq = 0;
  const auto first = published(f, seq), second = published(f, seq);
  REQUIRE(first.size() > 2);
  SyncReportReader reader;
  CHECK_FALSE(reader.push(first[0]));
  for (std::size_t i = 0; i + 1 < second.size(); ++i) CHECK_FALSE(reader.push(second[i]));
  for (std::size_t i = 1; i < first.size(); ++i) CHECK_FALSE(reader.push(first[i]));
  CHECK(reader.push(second.back()));
}
