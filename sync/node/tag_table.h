// Joins TAG_LIST and TAG_VALUES into named values, for programs that show, record or follow tagged variables. Pure; bounded
// for any input.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tactus/tag_def_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_values_t.hpp>
#include <utility>
#include <vector>

namespace tactus::sync {

class TagTable {
 public:
  // Maximum number of stored lists, including outdated ones; the oldest is removed first.
  static constexpr std::size_t kMaxLists = 64;

  struct List {
    std::string node;
    std::vector<tag_def_t> tags;  // by number; an empty name: not received yet
    std::int64_t received_order = 0;       // increases with each received list
  };

  void push(const tag_list_t& m);

  // Calls visit(const List&, const tag_def_t&, std::int64_t time_ns, double value) for each present value, row by row.
  // time_ns: CLOCK_MONOTONIC of the sender. Values without a list are counted.
  template <class Visit>
  void read(const tag_values_t& m, Visit&& visit) {
    const auto known = lists_.find({m.header.incarnation, m.list});
    std::size_t i = 0;
    for (const std::int64_t time_ns : m.times_ns)
      for (const std::int16_t column : m.columns) {
        const double value = m.values[i++];
        const tag_def_t* def = known == lists_.end() ? nullptr : tag(known->second, column);
        if (def == nullptr)
          ++unlisted_;
        else if (value != tag_values_t::NONE)
          visit(known->second, *def, time_ns, value);
      }
  }

  // The lists by the incarnation of the process and the number of the list.
  const std::map<std::pair<std::int64_t, std::int64_t>, List>& lists() const { return lists_; }
  // Number of values whose list has not been received.
  std::int64_t unlisted() const { return unlisted_; }

 private:
  static const tag_def_t* tag(const List& list, std::int16_t number) {
    const auto i = static_cast<std::size_t>(number);
    return number < 0 || i >= list.tags.size() || list.tags[i].name.empty() ? nullptr : &list.tags[i];
  }

  std::map<std::pair<std::int64_t, std::int64_t>, List> lists_;
  std::int64_t received_ = 0;
  std::int64_t unlisted_ = 0;
};

}  // namespace tactus::sync
