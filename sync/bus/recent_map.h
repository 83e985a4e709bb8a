// The newest keys and a value of each: a memory of what has been received, of bounded size. Pure.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <utility>

namespace tactus::sync {

template <class Key, class Value>
class RecentMap {
 public:
  // The oldest key is forgotten when there are more than max >= 1.
  explicit RecentMap(std::size_t max) : max_(max) {}

  // The value of a key, and whether the key is new; then its value is `value`.
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
  // Null: the key is not known, or not any more.
  const Value* find(const Key& key) const {
    const auto at = values_.find(key);
    return at == values_.end() ? nullptr : &at->second;
  }
  // use(key, value), the newest key first, until it returns false.
  template <class Use>
  void each_newest_first(Use use) const {
    for (auto key = order_.rbegin(); key != order_.rend(); ++key)
      if (!use(*key, values_.at(*key))) return;
  }
  // By key.
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
