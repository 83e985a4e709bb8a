// Serialization of a state to bytes and back. A class with state lists its members once, in order, for both
// directions:
//
// void archive(StateArchive& a) { a(steps_), a(place_m_), a.list(live_, kMax, [&](auto& c) { c.archive(a); }); }
//
// Every number takes eight bytes, little-endian. Doubles are stored unchanged, so a round trip is bit-identical.
#pragma once

#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "sync/time/time.h"

namespace tactus::sim {

// Invalid bytes of a state; what() is one sentence.
struct InvalidState : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class StateArchive {
 public:
  using Bytes = std::vector<std::uint8_t>;

  StateArchive() = default;                                                                   // writes
  explicit StateArchive(std::span<const std::uint8_t> bytes) : reads_(true), left_(bytes) {}  // reads

  bool reads() const { return reads_; }
  const Bytes& bytes() const { return bytes_; }
  // When reading: whether all bytes have been read.
  bool at_end() const { return left_.empty(); }
  void require(bool holds, const char* sentence) const {
    if (!holds) throw InvalidState(sentence);
  }

  void operator()(std::uint64_t& x) {
    static_assert(std::endian::native == std::endian::little);
    if (!reads_) {
      const std::size_t at = bytes_.size();
      bytes_.resize(at + sizeof x);
      std::memcpy(bytes_.data() + at, &x, sizeof x);
      return;
    }
    require(left_.size() >= sizeof x, "the state ends too early");
    std::memcpy(&x, left_.data(), sizeof x);
    left_ = left_.subspan(sizeof x);
  }
  void operator()(std::int64_t& x) {
    auto bits = static_cast<std::uint64_t>(x);
    (*this)(bits);
    x = static_cast<std::int64_t>(bits);
  }
  void operator()(int& x) {
    std::int64_t wide = x;
    (*this)(wide);
    require(wide >= INT32_MIN && wide <= INT32_MAX, "the state holds a number out of range");
    x = static_cast<int>(wide);
  }
  // Index into a list of `size` items; -1: none.
  void index(int& x, std::size_t size) {
    (*this)(x);
    require(x >= -1 && x < static_cast<std::int64_t>(size),
            "the state refers to a body, shape or surface that does not exist");
  }
  void operator()(bool& x) {
    std::int64_t wide = x ? 1 : 0;
    (*this)(wide);
    require(wide == 0 || wide == 1, "the state holds a number out of range");
    x = wide == 1;
  }
  void operator()(double& x) {
    auto bits = std::bit_cast<std::uint64_t>(x);
    (*this)(bits);
    x = std::bit_cast<double>(bits);
    require(!reads_ || std::isfinite(x), "the state holds a number that is not finite");
  }
  template <class Derived>
  void operator()(Eigen::PlainObjectBase<Derived>& m) {
    for (Eigen::Index i = 0; i < m.size(); ++i) (*this)(m.data()[i]);
  }
  void operator()(Eigen::Quaterniond& q) { (*this)(q.coeffs()); }
  void operator()(sync::SimTime& t) {
    std::int64_t ns = sync::to_ns(t);
    (*this)(ns);
    // One year: sums of such times do not overflow.
    require(ns >= -kMaxTime_ns && ns <= kMaxTime_ns, "the state holds a time out of range");
    t = sync::sim_time(ns);
  }
  void operator()(std::string& text) {
    std::uint64_t size = text.size();
    (*this)(size);
    if (reads_) {
      require(size <= left_.size(), "the state ends too early");
      text.assign(left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(size));
      left_ = left_.subspan(size);
    } else {
      bytes_.insert(bytes_.end(), text.begin(), text.end());
    }
  }
  // A list with a maximum length.
  template <class Item, class Each>
  void list(std::vector<Item>& items, std::size_t max_size, Each each) {
    std::uint64_t size = items.size();
    (*this)(size);
    require(size <= max_size && (!reads_ || size <= left_.size()), "the state holds a list that is too long");
    if (reads_) items.resize(size);
    for (Item& item : items) each(item);
  }
  // A list whose length is fixed by the world.
  template <class Item, class Each>
  void fixed(std::vector<Item>& items, Each each) {
    std::uint64_t size = items.size();
    (*this)(size);
    require(size == items.size(), "the state belongs to another scene");
    for (Item& item : items) each(item);
  }
  // A message or a part of one.
  template <class Message>
  void message(Message& m) {
    std::string text;
    if (!reads_) {
      text.resize(static_cast<std::size_t>(m.getEncodedSize()));
      m.encode(text.data(), 0, static_cast<int>(text.size()));
    }
    (*this)(text);
    if (!reads_) return;
    m = Message{};
    bool whole = false;
    try {
      whole = m.decode(text.data(), 0, static_cast<int>(text.size())) == static_cast<int>(text.size());
    } catch (const std::exception&) {  // the generated decoder throws on invalid lengths
    }
    require(whole, "the state holds a damaged message");
  }

 private:
  static constexpr std::int64_t kMaxTime_ns = 366ll * 24 * 3600 * 1'000'000'000;

  bool reads_ = false;
  Bytes bytes_;
  std::span<const std::uint8_t> left_;
};

}  // namespace tactus::sim
