// Reassembles messages that are sent in pages. Pure. Bounded, also when pages are lost, repeated, reordered or forged.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

namespace tactus::sync {

// The pages of one message.
template <class Page>
class PageGroup {
 public:
  struct Numbered {
    int number;
    Page page;
  };

  // Stores page `number` of `count`. A page replaces one of the same number; a page with another count restarts the group.
  // Returns false, without a change, for a number out of range.
  bool put(int number, int count, Page page) {
    if (number < 0 || number >= count) return false;
    if (count != count_) pages_.clear();
    count_ = count;
    const auto before = [](const Numbered& p, int n) { return p.number < n; };
    const auto at = std::lower_bound(pages_.begin(), pages_.end(), number, before);
    if (at != pages_.end() && at->number == number)
      at->page = std::move(page);
    else
      pages_.insert(at, {number, std::move(page)});
    return true;
  }
  bool complete() const { return count_ > 0 && pages_.size() == static_cast<std::size_t>(count_); }
  // Returns null when the page has not arrived.
  const Page* find(int number) const {
    for (const Numbered& p : pages_)
      if (p.number == number) return &p.page;
    return nullptr;
  }
  std::size_t size() const { return pages_.size(); }
  // Iterates over the pages in order of their numbers.
  auto begin() { return pages_.begin(); }
  auto end() { return pages_.end(); }
  auto begin() const { return pages_.begin(); }
  auto end() const { return pages_.end(); }
  // Removes the pages; keeps the allocated memory.
  void clear() {
    pages_.clear();
    count_ = 0;
  }

 private:
  std::vector<Numbered> pages_;
  int count_ = 0;
};

struct PageLimits {
  std::size_t groups = 4;             // maximum number of incomplete groups
  int pages = 1024;                   // maximum number of pages of one message; pages of larger messages are ignored
  std::size_t total = SIZE_MAX;       // maximum number of pages of all incomplete groups, while there are two or more groups
  std::size_t remembered = 0;         // number of newest complete groups whose repeated pages are ignored
};

// The incomplete group to drop when there are too many: the one whose first page is the oldest, the one whose newest page is
// the oldest, or the one with the smallest key.
enum class PageOrder : std::uint8_t { kFirstPage, kNewestPage, kKey };

// Key: the same for all pages of one message, and different for those of other messages. Realtime-safe once its memory has
// grown, if Page is.
template <class Page, class Key>
class PageAssembler {
 public:
  struct Group {
    Key key{};
    PageGroup<Page> pages;
  };

  explicit PageAssembler(const PageLimits& limits, PageOrder order = PageOrder::kFirstPage) : limits_(limits), order_(order) {}

  // Stores a page. Returns the group when this page completes it, valid until the next call; else null. Calls
  // on_drop(Group&) for each incomplete group that is dropped to keep the limits.
  template <class OnDrop>
  Group* add(const Key& key, int number, int count, Page page, OnDrop&& on_drop) {
    repeated_ = std::find(done_.begin(), done_.end(), key) != done_.end();
    if (repeated_ || count > limits_.pages || number < 0 || number >= count) return nullptr;
    const auto at = group_of(key);
    at->pages.put(number, count, std::move(page));
    if (at->pages.complete()) return finish(at);
    while (groups_.size() > limits_.groups || (groups_.size() > 1 && too_many_pages())) {
      on_drop(groups_.front());
      recycle(groups_.begin());
    }
    return nullptr;
  }
  Group* add(const Key& key, int number, int count, Page page) {
    return add(key, number, count, std::move(page), [](Group&) {});
  }
  // True when the page that was added last belongs to a remembered complete group.
  bool repeated() const { return repeated_; }
  // Number of incomplete groups.
  std::size_t size() const { return groups_.size(); }
  // Drops the incomplete groups for which predicate(key) is true.
  template <class Predicate>
  void drop_if(Predicate&& predicate) {
    std::erase_if(groups_, [&](const Group& g) { return predicate(g.key); });
  }
  void clear() { groups_.clear(); }

 private:
  using Iterator = typename std::vector<Group>::iterator;

  Iterator group_of(const Key& key) {
    const auto known = std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) { return g.key == key; });
    if (known != groups_.end()) {
      if (order_ != PageOrder::kNewestPage) return known;
      std::rotate(known, known + 1, groups_.end());
      return groups_.end() - 1;
    }
    auto at = groups_.end();
    if constexpr (requires { key < key; })
      if (order_ == PageOrder::kKey)
        at = std::upper_bound(groups_.begin(), at, key, [](const Key& k, const Group& g) { return k < g.key; });
    Group fresh;
    if (!spare_.empty()) {
      fresh = std::move(spare_.back());
      spare_.pop_back();
    }
    fresh.key = key;
    return groups_.insert(at, std::move(fresh));
  }
  Group* finish(Iterator at) {
    std::swap(completed_, *at);
    recycle(at);
    if (limits_.remembered == 0) return &completed_;
    done_.push_back(completed_.key);
    if (done_.size() > limits_.remembered) done_.pop_front();
    return &completed_;
  }
  void recycle(Iterator at) {
    at->pages.clear();
    spare_.push_back(std::move(*at));
    groups_.erase(at);
  }
  bool too_many_pages() const {
    if (limits_.total == SIZE_MAX) return false;
    std::size_t pages = 0;
    for (const Group& g : groups_) pages += g.pages.size();
    return pages > limits_.total;
  }

  PageLimits limits_;
  PageOrder order_;
  std::vector<Group> groups_, spare_;  // in the order in which they are dropped
  Group completed_;
  std::deque<Key> done_;
  bool repeated_ = false;
};

}  // namespace tactus::sync
