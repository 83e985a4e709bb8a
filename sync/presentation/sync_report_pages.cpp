#include "sync/presentation/sync_report_pages.h"

#include <tactus/modality_report_t.hpp>
#include <tactus/pair_report_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/presentation/thresholds.h"

namespace tactus::sync {
namespace {

// Writes entries to pages, each to the newest page while it fits.
class PageWriter {
 public:
  explicit PageWriter(const sync_report_t& head) : head_(head), pages_{head} {}

  template <class List, class Count, class Entry>
  void add(List sync_report_t::* list, Count sync_report_t::* count, const Entry& entry) {
    if (fits(pages_.back(), list, count, entry)) return;
    if (pages_.back().modality_count + pages_.back().pair_count == 0) return;  // too long for any page
    pages_.push_back(head_);
    if (!fits(pages_.back(), list, count, entry)) pages_.pop_back();
  }
  std::vector<sync_report_t> finish() {
    for (std::size_t i = 0; i < pages_.size(); ++i) {
      pages_[i].page = static_cast<std::int32_t>(i);
      pages_[i].pages = static_cast<std::int32_t>(pages_.size());
    }
    return std::move(pages_);
  }

 private:
  // Appends the entry if it fits.
  template <class List, class Count, class Entry>
  static bool fits(sync_report_t& page, List sync_report_t::* list, Count sync_report_t::* count, const Entry& entry) {
    (page.*list).push_back(entry);
    page.*count = static_cast<Count>((page.*list).size());
    if (page.getEncodedSize() <= static_cast<int>(channels::kMaxMessageBytes)) return true;
    (page.*list).pop_back();
    page.*count = static_cast<Count>((page.*list).size());
    return false;
  }

  sync_report_t head_;
  std::vector<sync_report_t> pages_;
};

}  // namespace

std::vector<sync_report_t> report_pages(const PresentationMatcher& matcher) {
  sync_report_t head{};
  head.header.sim_time_ns = -1;
  head.pages = 1;
  head.begins = matcher.begins();
  head.hits = matcher.hits();
  head.ends = matcher.ends();
  PageWriter writer(head);
  for (const auto& [name, t] : matcher.modalities())
    writer.add(&sync_report_t::modalities, &sync_report_t::modality_count,
               modality_report_t{name, t.expected, t.presented, t.lost, t.stalled, t.dead, t.dropped_by_profile, t.dropped_late});
  for (const auto& [names, soa] : matcher.pairs()) {
    const BeyondThresholds beyond = count_beyond_thresholds(names.first, names.second, soa);
    writer.add(&sync_report_t::pairs, &sync_report_t::pair_count,
               pair_report_t{names.first, names.second, soa.count(), soa.quantile(0.05).count(), soa.quantile(0.5).count(),
                             soa.quantile(0.95).count(), soa.uncertainty().count(), beyond.least, beyond.all});
  }
  return writer.finish();
}

std::optional<sync_report_t> SyncReportReader::push(const sync_report_t& page) {
  const std::int64_t first = page.header.seq - page.page;
  if (page.header.incarnation == incarnation_ && first < first_seq_) return std::nullopt;
  if (page.header.incarnation != incarnation_ || first != first_seq_) pages_.clear();
  incarnation_ = page.header.incarnation;
  first_seq_ = first;
  const auto* group = pages_.add(first, page.page, page.pages, page);
  if (!group) return std::nullopt;
  sync_report_t whole = page;
  whole.page = 0, whole.pages = 1;
  whole.modalities.clear(), whole.pairs.clear();
  for (const auto& [number, part] : group->pages) {
    whole.modalities.insert(whole.modalities.end(), part.modalities.begin(), part.modalities.end());
    whole.pairs.insert(whole.pairs.end(), part.pairs.begin(), part.pairs.end());
  }
  whole.modality_count = static_cast<std::int32_t>(whole.modalities.size());
  whole.pair_count = static_cast<std::int32_t>(whole.pairs.size());
  return whole;
}

}  // namespace tactus::sync
