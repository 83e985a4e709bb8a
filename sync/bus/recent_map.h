// A map of bounded size that keeps the newest keys, for instance of received messages. Pure.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <utility>

namespace tactus::sync {

template <class Key, class Value>
class RecentMap {
 public:
  // Removes the oldest key when there are more than max >= 1.
  explicit RecentMap(std::size_t max) : max_(max) {}

  // Returns the value of a key, and whether the key is new; a new key gets `value`.
  std::pair<Value&, bool> try_emplace(const Key& key, Value value = {}) {
    const auto [at, is_new] = values_.try_emplace(key, std::move(value));
    if (!is_new) return {at->second, false};
    order_.push_back(key);
    if (order_.size() > max_) {
      values_.erase(order_.front());
      order_.pop_front();
    }
    return {at->second, true};
  }
  // Returns null when the key was never added or has been removed.
  const Value* find(const Key& key) const {
    const auto at = values_.find(key);
    return at == values_.end() ? nullptr : &at->second;
  }
  // Calls use(key, value), newest key first, until it returns false.
  template <class Use>
  void each_newest_first(Use use) const {
    for (auto key = order_.rbegin(); key != order_.rend(); ++key)
      if (!use(*key, values_.at(*key))) return;
  }
  // In order of the keys.
  auto begin() { return values_.begin(); }
  auto end() { return values_.end(); }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }
  std::size_t size() const { return values_.size(); }
  void clear() {
    values_.clear();
    order_.clear();
  }

 private:
  std::size_t max_;
  std::map<Key, Value> values_;
  std::deque<Key> order_;
};

}  // namespace tactus::sync
