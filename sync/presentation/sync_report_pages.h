// SYNC_REPORT in pages that fit a datagram, and pages put together again. Pure.
#pragma once

#include <optional>
#include <tactus/sync_report_t.hpp>
#include <vector>

#include "sync/bus/page_assembler.h"
#include "sync/presentation/presentation_matcher.h"

namespace tactus::sync {

// All that was matched so far, headers unstamped: publish them in order. An entry whose name alone is too long for a page is
// left out.
std::vector<sync_report_t> report_pages(const PresentationMatcher& matcher);

// Collects pages into whole reports.
class SyncReportReader {
 public:
  // The report as if it were one page, once its last page is here. Pages have consecutive numbers; those of an older report
  // are dropped.
  std::optional<sync_report_t> take(const sync_report_t& page);

 private:
  std::int64_t incarnation_ = 0, first_seq_ = -1;
  PageAssembler<sync_report_t, std::int64_t> pages_{{.groups = 1}};  // by the number of the first
};

}  // namespace tactus::sync
