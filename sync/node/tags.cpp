#include "sync/node/tags.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tactus/tag_def_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/bus/identity.h"

namespace tactus::sync {
namespace {

// A row with this number of columns fits a datagram: 12 bytes a column, and 140 for the rest.
constexpr std::size_t kMaxColumns = 100;
constexpr std::size_t kMaxRows = 128;

bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= 48 &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-") ==
             std::string::npos;
}

std::size_t size_of(const tag_def_t& def) { return static_cast<std::size_t>(def.getEncodedSize()); }

std::size_t rows_that_fit(tag_values_t m) {
  m.row_count = m.value_count = 0;
  m.times_ns.clear(), m.values.clear();
  const auto head = static_cast<std::size_t>(m.getEncodedSize());
  return std::min(kMaxRows, (channels::kMaxMessageBytes - head) / (8 + 8 * m.columns.size()));
}

void clear(tag_values_t& m) {
  m.row_count = m.value_count = 0;
  m.times_ns.clear(), m.values.clear();
}

}  // namespace

void Tags::add(std::string name, std::string unit, Getter getter, double rate_Hz) {
  const auto refuse = [&](const std::string& reason) {
    throw std::invalid_argument("cannot tag \"" + name + "\": " + reason);
  };
  if (!is_name(name)) refuse("a name has 1 to 48 letters, digits, '.', '_' and '-'");
  if (unit.empty() || unit.size() > 16) refuse("its unit has 1 to 16 characters; \"1\" for a plain number");
  if (!(rate_Hz >= 0 && rate_Hz <= 1e6)) refuse("its rate must be between 0 and 1 MHz");
  if (tags_.size() >= kMax) refuse("there are 1024 already");
  for (const Tag& tag : tags_)
    if (tag.def.name == name) refuse("there is one of that name already");
  tags_.push_back({{std::move(name), std::move(unit), rate_Hz}, std::move(getter)});
  list_ = 0;
  if (requests_.any()) build_blocks();
}

void Tags::page_list() {
  std::uint64_t hash = fnv1a_64(kFnv1aBegin, node_.data(), node_.size());
  for (const Tag& tag : tags_) {
    hash = fnv1a_64(hash, tag.def.name.c_str(), tag.def.name.size() + 1);
    hash = fnv1a_64(hash, tag.def.unit.c_str(), tag.def.unit.size() + 1);
    hash = fnv1a_64(hash, &tag.def.rate_Hz, sizeof tag.def.rate_Hz);
  }
  list_ = static_cast<std::int64_t>(hash >> 1) | 1;
  pages_.clear();
  std::size_t room = 0;
  for (std::size_t i = 0; i < tags_.size(); ++i) {
    if (pages_.empty() || size_of(tags_[i].def) > room) {
      tag_list_t page{};
      page.header.sim_time_ns = -1;
      page.node = node_, page.list = list_;
      page.first = static_cast<std::int16_t>(i), page.total = static_cast<std::int16_t>(tags_.size());
      room = channels::kMaxMessageBytes - static_cast<std::size_t>(page.getEncodedSize());
      pages_.push_back(std::move(page));
    }
    room -= size_of(tags_[i].def);
    pages_.back().tags.push_back(tags_[i].def);
    ++pages_.back().tag_count;
  }
  next_page_ = pages_.size();
}

// Discards pending values; it runs only when a requester appears or disappears.
void Tags::build_blocks() {
  if (list_ == 0) page_list();
  blocks_.clear();
  sent_ = 0;
  for (std::size_t i = 0; i < tags_.size(); ++i) {
    const tag_def_t& def = tags_[i].def;
    if (!requests_.is_requested(node_ + "." + def.name)) continue;
    auto block = std::find_if(blocks_.begin(), blocks_.end(), [&](const Block& b) {
      return b.rate_Hz == def.rate_Hz && b.message.columns.size() < kMaxColumns;
    });
    if (block == blocks_.end()) {
      block = blocks_.insert(blocks_.end(), Block{.rate_Hz = def.rate_Hz, .max_rows = 0, .message = {}});
      block->message.header.sim_time_ns = -1;
      block->message.node = node_, block->message.list = list_;
    }
    block->message.columns.push_back(static_cast<std::int16_t>(i));
    ++block->message.column_count;
  }
  for (Block& block : blocks_) {
    block.max_rows = rows_that_fit(block.message);
    block.message.times_ns.reserve(block.max_rows);
    block.message.values.reserve(block.max_rows * block.message.columns.size());
  }
}

void Tags::push(const tag_request_t& request, HostTime now) {
  const bool first = !requests_.any();
  if (!requests_.push(request, now)) return;
  build_blocks();
  if (first) list_due_ = now;
  next_page_ = 0;  // a new requester needs the names
}

void Tags::append_row(Block& block, HostTime now) {
  tag_values_t& m = block.message;
  if (m.row_count == 0) block.first_row = now;
  m.times_ns.push_back(to_ns(now));
  ++m.row_count;
  for (const std::int16_t column : m.columns) {
    const double value = tags_[static_cast<std::size_t>(column)].getter();
    m.values.push_back(std::isfinite(value) ? value : tag_values_t::NONE);
  }
  m.value_count = static_cast<std::int32_t>(m.values.size());
}

void Tags::step(HostTime now) {
  if (!requests_.any()) return;
  if (requests_.expire(now)) build_blocks();
  if (now >= list_due_ && requests_.any()) {
    list_due_ = now + kListPeriod;
    next_page_ = 0;
  }
  for (Block& block : blocks_) {
    if (now >= block.next) {
      append_row(block, now);
      if (block.rate_Hz > 0) {
        const Nanoseconds period = from_seconds(1 / block.rate_Hz);
        block.next = block.next + period > now ? block.next + period : now + period;
      }
    }
    block.full = static_cast<std::size_t>(block.message.row_count) >= block.max_rows ||
                 (block.message.row_count > 0 && now - block.first_row >= kSendPeriod);
  }
}

tag_list_t* Tags::next_list() {
  if (!requests_.any() || next_page_ >= pages_.size()) return nullptr;
  return &pages_[next_page_++];
}

tag_values_t* Tags::next_values() {
  if (sent_ > 0) {
    clear(blocks_[sent_ - 1].message);
    blocks_[sent_ - 1].full = false;
  }
  for (sent_ = 0; sent_ < blocks_.size();)
    if (blocks_[sent_++].full) return &blocks_[sent_ - 1].message;
  return sent_ = 0, nullptr;
}

}  // namespace tactus::sync
