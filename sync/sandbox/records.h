// The output of a reader program: records of a kind and a content. And values packed into a content.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace tactus::sync {

// kind: 'R' a result, 'E' an error in one clause; other letters as the reader defines.
struct Record {
  char kind = 'R';
  std::vector<std::uint8_t> content;
};

// On the wire: the kind, the size of the content as 64 bits, the content.
inline constexpr std::size_t kRecordHeaderBytes = 9;

// Moves the complete records from the front of `bytes` into `records`.
void split_records(std::vector<std::uint8_t>& bytes, std::vector<Record>& records);

// Appends values in the byte order of this machine: writer and reader are one build.
class Packer {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* from = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), from, from + sizeof value);
  }
  // A number of elements and their bytes; T: trivially copyable, or a fixed Eigen vector of plain numbers.
  template <typename List>
  void put_list(const List& list) {
    put(static_cast<std::uint64_t>(list.size()));
    const auto* from = reinterpret_cast<const std::uint8_t*>(list.data());
    bytes_.insert(bytes_.end(), from, from + list.size() * sizeof(typename List::value_type));
  }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

// Reads them back. Throws std::runtime_error with one clause when the content is too short: the reader program may be
// under the control of the file that it read.
class Unpacker {
 public:
  explicit Unpacker(std::span<const std::uint8_t> bytes) : left_(bytes) {}

  template <typename T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  template <typename List>
  List get_list() {
    constexpr std::size_t kBytes = sizeof(typename List::value_type);
    const auto count = get<std::uint64_t>();
    if (count > left_.size() / kBytes) reject();  // before the allocation
    List list(static_cast<std::size_t>(count), typename List::value_type{});
    const auto from = take(list.size() * kBytes);
    if (!from.empty()) std::memcpy(static_cast<void*>(list.data()), from.data(), from.size());
    return list;
  }
  // A number of entries that follow, each of at least min_bytes.
  std::size_t get_count(std::size_t min_bytes) {
    const auto count = get<std::uint64_t>();
    if (count > left_.size() / min_bytes) reject();
    return static_cast<std::size_t>(count);
  }
  bool at_end() const { return left_.empty(); }

 private:
  [[noreturn]] static void reject() { throw std::runtime_error("its reader returned an incomplete result"); }
  std::span<const std::uint8_t> take(std::size_t count) {
    if (count > left_.size()) reject();
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }

  std::span<const std::uint8_t> left_;
};

}  // namespace tactus::sync
