#include "sync/tools/channel_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>
#include <tactus/log_info_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/tag_def_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_values_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"
#include "sync/log/log_header.h"
#include "sync/text/csv.h"

namespace tactus::sync {
namespace {

constexpr std::string_view kHeader = "header.";

std::string number(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return std::string(text, end);
}

std::string seconds(std::int64_t ns) {
  char text[40];
  std::snprintf(text, sizeof text, "%s%lld.%09lld", ns < 0 ? "-" : "",
                static_cast<long long>(std::abs(ns) / 1'000'000'000),
                static_cast<long long>(std::abs(ns) % 1'000'000'000));
  return text;
}

// The leading columns of every row of a message.
std::string begin_of(const TableContext& context, const LogEvent& event, HostTime arrival) {
  const auto header = peek_header(event.data.data(), event.data.size());
  std::string text = seconds(to_ns(arrival) - context.origin().info.live_from_ns) + ",";
  if (header && header->sim_time_ns >= 0) text += seconds(header->sim_time_ns);
  text += "," + (header ? csv_cell(std::string_view(context.sender(header->source))) : std::string()) + ",";
  if (header) text += std::to_string(header->seq);
  return text;
}

// As for_each_leaf; also false when a number is not finite: no receiver accepts such a message (lcmtypes/valid.h).
bool for_each_finite_leaf(const MessageType& type, std::span<const std::uint8_t> bytes,
                          const std::function<void(const std::string&, const Field&, const Leaf&)>& visit) {
  bool finite = true;
  const bool whole = for_each_leaf(type, bytes, [&](const std::string& path, const Field& field, const Leaf& value) {
    const auto* real = std::get_if<double>(&value);
    if (real && !std::isfinite(*real)) finite = false;
    visit(path, field, value);
  });
  return whole && finite;
}

}  // namespace

void TableContext::learn(const LogEvent& event) {
  if (event.channel == channels::kNodeHealth && names_.size() < kMaxNames) {
    if (const auto m = decode<node_health_t>(event.data.data(), event.data.size()))
      names_.emplace(m->header.source, m->node);
  } else if (event.channel == channels::kTagList) {
    if (const auto m = decode<tag_list_t>(event.data.data(), event.data.size())) tags_.push(*m);
  }
}

double TableContext::log_s(HostTime arrival) const {
  return static_cast<double>(to_ns(arrival) - origin_.info.live_from_ns) * 1e-9;
}

std::string TableContext::sender(std::int32_t source) const {
  if (const auto it = names_.find(source); it != names_.end()) return it->second;
  char text[16];
  std::snprintf(text, sizeof text, "0x%08x", static_cast<unsigned>(source));
  return text;
}

std::string csv_cell(const Leaf& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return csv_cell(std::string_view(*text));
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  return number(std::get<double>(value));
}

std::string long_names() { return "log_s,world_s,sender,seq,field,unit,value,run\n"; }

std::string long_rows(const TableContext& context, const MessageType& type, const LogEvent& event,
                      HostTime arrival) {
  const std::string begin = begin_of(context, event, arrival), end = "," + std::to_string(context.run()) + "\n";
  std::string rows;
  const bool whole =
      for_each_finite_leaf(type, event.data, [&](const std::string& path, const Field&, const Leaf& value) {
        if (path.starts_with(kHeader)) return;
        rows += begin + "," + path + "," + unit_of_path(path) + "," + csv_cell(value) + end;
      });
  return whole ? rows : "";
}

WideColumns::WideColumns(const MessageType& type) : type_(type) {
  const std::function<void(const MessageType&, const std::string&)> add = [&](const MessageType& in,
                                                                              const std::string& prefix) {
    for (const Field& field : in.fields) {
      const std::string path = prefix + std::string(field.name);
      if (!field.count.empty() || path == "header") continue;
      if (const MessageType* inner = message_type(field.type))
        add(*inner, path + ".");
      else
        column_.emplace(path, paths_.size()), paths_.push_back(path);
    }
  };
  add(type, "");
}

std::string WideColumns::names() const {
  std::string text = "log_s,world_s,sender,seq";
  for (const std::string& path : paths_) {
    const std::string unit = unit_of_path(path);
    text += "," + csv_cell(std::string_view(path + (unit.empty() ? "" : " (" + unit + ")")));
  }
  return text + ",run\n";
}

std::string WideColumns::row(const TableContext& context, const LogEvent& event, HostTime arrival) const {
  std::vector<std::string> cells(paths_.size());
  const bool whole =
      for_each_finite_leaf(type_, event.data, [&](const std::string& path, const Field&, const Leaf& value) {
        if (const auto it = column_.find(path); it != column_.end()) cells[it->second] = csv_cell(value);
      });
  if (!whole) return "";
  std::string text = begin_of(context, event, arrival);
  for (const std::string& cell : cells) text += "," + cell;
  return text + "," + std::to_string(context.run()) + "\n";
}

std::string tag_names() { return "log_s,node,tag,unit,value,run\n"; }

std::string tag_rows(TagTable& tags, const TableContext& context, const LogEvent& event, HostTime arrival, const LogInterval& interval) {
  const auto m = decode<tag_values_t>(event.data.data(), event.data.size());
  std::string rows;
  if (!m) return rows;
  // Exact on the recorder's own clock; on another clock, the event precedes the arrival by as much as it precedes the
  // publication.
  const log_info_t& info = context.origin().info;
  const std::int64_t sent_ns =
      (m->header.clock == info.header.clock ? 0 : to_ns(arrival) - m->header.publish_time_ns) - info.live_from_ns;
  tags.read(*m, [&](const TagTable::List& list, const tag_def_t& tag, std::int64_t time_ns, double value) {
    if (!interval.contains(sent_ns + time_ns)) return;
    rows += seconds(sent_ns + time_ns) + "," + csv_cell(std::string_view(list.node)) + "," + csv_cell(std::string_view(tag.name)) + "," +
            csv_cell(std::string_view(tag.unit)) + "," + number(value) + "," + std::to_string(context.run()) + "\n";
  });
  return rows;
}

std::string foreign_names() { return "log_s,bytes,data_hex,run\n"; }

std::string foreign_row(const TableContext& context, const LogEvent& event, HostTime arrival) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = seconds(to_ns(arrival) - context.origin().info.live_from_ns) + "," + std::to_string(event.data.size()) + ",";
  text.reserve(text.size() + 2 * event.data.size() + 12);
  for (const std::uint8_t byte : event.data) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text + "," + std::to_string(context.run()) + "\n";
}

std::string table_file_of(std::string_view channel, std::set<std::string>& used) {
  const auto kept = [](char c) { return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' || c == '.' || c == '_'; };
  std::string name;
  for (const char c : channel) name += kept(c) ? c : '_';
  if (name.empty() || name[0] == '.') name.insert(0, 1, '_');
  std::string file = name + ".csv";
  if (type_on(channel) == nullptr)
    for (int number = 2; used.contains(file); ++number) file = name + "." + std::to_string(number) + ".csv";
  used.insert(file);
  return file;
}

std::set<std::string> reserved_table_files() {
  std::set<std::string> files{"tags.csv",      "events.csv",      "presented.csv", "media_clock.csv",
                              "clock_map.csv", "frame_shown.csv", "haptic.csv",    "thermal.csv"};
  for (const Channel& c : channel_types()) files.insert(std::string(c.name) + ".csv");
  return files;
}

}  // namespace tactus::sync
