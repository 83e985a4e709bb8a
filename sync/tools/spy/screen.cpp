#include "sync/tools/spy/screen.h"

#include <algorithm>
#include <cstdio>
#include <tactus/tag_def_t.hpp>
#include <tactus/tag_values_t.hpp>

#include "lcmtypes/utf8.h"
#include "sync/text/printable.h"

namespace tactus::sync::spy {
namespace {

constexpr std::size_t kNameColumns = 18, kLongestValue = 40;
constexpr const char* kKeys = "up down  enter: fields  esc: back  t: variables  p: pause  q: quit";

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string bytes_text(double per_s) {
  return per_s >= 1e6 ? format("%.2f MB/s", per_s / 1e6) : format("%.1f kB/s", per_s / 1e3);
}

std::string padded(std::string text, std::size_t columns) {
  const std::size_t shown = character_count(text);
  return shown < columns ? text + std::string(columns - shown, ' ') : std::string(first_characters(text, columns));
}

// Truncates text to the width, one column a character.
std::string cut(const std::string& text, std::size_t columns) { return std::string(first_characters(text, columns)); }

std::string age_text(const ChannelFigures& f) {
  if (f.type.empty()) return "";
  return format("%.2f", f.age_ms) + (f.age_uncertainty_ms < 0   ? " ?"
                                     : f.age_uncertainty_ms > 0 ? format("+-%.2f", f.age_uncertainty_ms)
                                                                : "");
}

std::string text_of(const Leaf& value) {
  if (const auto* text = std::get_if<std::string>(&value))
    return "\"" + printable(first_characters(*text, kLongestValue)) + "\"";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  return format("%.6g", std::get<double>(value));
}

const char* kTitles[] = {"channel", "field", "variable"};

}  // namespace

std::vector<Key> take_keys(std::string& bytes) {
  std::vector<Key> keys;
  std::size_t at = 0;
  while (at < bytes.size()) {
    const std::string_view rest(bytes.data() + at, bytes.size() - at);
    if (rest[0] == '\x1b' && rest.size() >= 2 && (rest[1] == '[' || rest[1] == 'O')) {
      if (rest.size() < 3) break;
      std::size_t end = 2;
      while (end < rest.size() && (rest[end] == ';' || (rest[end] >= '0' && rest[end] <= '9'))) ++end;
      if (end == rest.size()) break;
      const std::string_view code = rest.substr(2, end - 2 + 1);
      keys.push_back(code == "A"    ? Key::kUp
                     : code == "B"  ? Key::kDown
                     : code == "5~" ? Key::kPageUp
                     : code == "6~" ? Key::kPageDown
                     : code == "D"  ? Key::kBack
                     : code == "C"  ? Key::kEnter
                                    : Key::kNone);
      at += end + 1;
      continue;
    }
    switch (rest[0]) {
      case 'k': keys.push_back(Key::kUp); break;
      case 'j': keys.push_back(Key::kDown); break;
      case '\r':
      case '\n': keys.push_back(Key::kEnter); break;
      case '\x1b':
      case '\x7f':
      case 'h': keys.push_back(Key::kBack); break;
      case 't': keys.push_back(Key::kTags); break;
      case 'p':
      case ' ': keys.push_back(Key::kPause); break;
      case 'q':
      case '\x03': keys.push_back(Key::kQuit); break;
      default: break;
    }
    ++at;
  }
  bytes.erase(0, at);
  if (bytes.size() > 16) bytes.clear();  // longer than any key sequence of a terminal
  return keys;
}

void Screen::press(Key key) {
  const auto open = [&](Page page) {
    page_ = page;
    cursor_ = top_ = 0;
    marked_name_.clear();
  };
  switch (key) {
    case Key::kUp: --pending_move_; break;
    case Key::kDown: ++pending_move_; break;
    case Key::kPageUp: pending_move_ -= 20; break;
    case Key::kPageDown: pending_move_ += 20; break;
    case Key::kEnter:
      if (page_ == Page::kChannels && !marked_name_.empty()) {
        channel_ = channel_before_ = marked_name_;
        open(Page::kFields);
      }
      break;
    case Key::kBack:
      open(Page::kChannels);
      marked_name_ = channel_before_;
      break;
    case Key::kTags: open(page_ == Page::kTags ? Page::kChannels : Page::kTags); break;
    case Key::kPause: paused_ = !paused_; break;
    case Key::kQuit: over_ = true; break;
    case Key::kNone: break;
  }
}

void Screen::push(const tag_values_t& m, HostTime arrival) {
  table_.read(m, [&](const TagTable::List& list, const tag_def_t& tag, std::int64_t, double value) {
    const std::string name = list.node + "." + tag.name;
    auto it = tags_.find(name);
    if (it == tags_.end()) {
      if (tags_.size() >= kMaxTags) return;
      it = tags_.emplace(name, Variable()).first;
    }
    it->second.unit = tag.unit;
    it->second.value = value;
    it->second.spark.add(value, arrival);
  });
}

void Screen::sample(const Channels& channels, HostTime now) {
  if (page_ != Page::kFields || marked_name_.empty()) return;
  if (graphed_path_ != channel_ + " " + marked_name_) {
    graphed_path_ = channel_ + " " + marked_name_;
    graph_ = Spark(kColumn);
  }
  const auto bytes = channels.newest(channel_);
  const MessageType* type = type_of(bytes);
  if (!type) return;
  try {
    if (const auto value = FieldPath(*type, marked_name_).number(bytes)) graph_.add(*value, now);
  } catch (const std::invalid_argument&) {
    // The newest message is of another type than the one whose fields were shown.
  }
}

std::vector<Screen::Row> Screen::channel_rows(const Channels& channels, HostTime now, std::size_t columns) const {
  std::vector<Row> rows;
  for (const ChannelFigures& f : channels.figures(now)) {
    std::string text =
        padded(cut(printable(f.name), kNameColumns), kNameColumns) +
        format(" %8.1f %11s %6lld %7.2f %7.2f %-13s %2d", f.rate_Hz, bytes_text(f.bytes_per_s).c_str(),
               static_cast<long long>(f.gaps), f.jitter.p50_ms, f.jitter.p99_ms, age_text(f).c_str(), f.senders);
    text += "  " + (f.type.empty() ? "(not ours)" : f.type);
    if (f.torn > 0) text += ", " + std::to_string(f.torn) + " torn";
    if (f.silent_s > 3) text += format(", silent for %.0f s", f.silent_s);
    rows.push_back({f.name, cut(text, columns)});
  }
  return rows;
}

std::vector<Screen::Row> Screen::field_rows(const Channels& channels, HostTime now, std::size_t columns) const {
  std::vector<Row> rows;
  const auto bytes = channels.newest(channel_);
  const MessageType* type = type_of(bytes);
  if (!type) {
    rows.push_back(
        {"", cut("no Tactus type; its " + std::to_string(bytes.size()) + " bytes begin with:", columns)});
    for (std::size_t at = 0; at < bytes.size() && at < 512; at += 16) {
      std::string line = format("%04zx ", at);
      for (std::size_t i = at; i < std::min(bytes.size(), at + 16); ++i) line += format(" %02x", bytes[i]);
      rows.push_back({"", cut(line, columns)});
    }
    return rows;
  }
  for_each_leaf(*type, bytes, [&](const std::string& path, const Field& field, const Leaf& value) {
    const std::string line = padded(cut(path, 40), 40) + " " + padded(text_of(value), 22) + " " +
                             padded(unit_of_path(path), 6) + " " + printable(std::string(field.comment));
    rows.push_back({path, cut(line, columns)});
    if (path != marked_name_ || std::holds_alternative<std::string>(value)) return;
    const std::size_t room = columns > 60 ? columns - 60 : 10;
    const Spark::Drawn graph = graph_.draw(now, std::min(room, Spark::kMax));
    rows.push_back({path + " ", "    " + graph.text + format("  %.4g .. %.4g", graph.lowest, graph.highest)});
  });
  return rows;
}

std::vector<Screen::Row> Screen::tag_rows(HostTime now, std::size_t columns) const {
  std::vector<Row> rows;
  const std::size_t room = columns > 66 ? std::min(columns - 58, Spark::kMax) : 0;
  for (const auto& [name, v] : tags_)
    rows.push_back({name, cut(padded(cut(name, 36), 36) + format(" %12.5g ", v.value) + padded(v.unit, 6),
                              columns - (room > 0)) +
                              (room > 0 ? " " + v.spark.draw(now, room).text : "")});
  return rows;
}

void Screen::move(const std::vector<Row>& rows, std::size_t visible) {
  const auto at = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name == marked_name_; });
  if (at != rows.end() && !marked_name_.empty()) cursor_ = static_cast<std::size_t>(at - rows.begin());
  const auto last = static_cast<std::int64_t>(rows.size()) - 1;
  cursor_ = static_cast<std::size_t>(
      std::clamp<std::int64_t>(static_cast<std::int64_t>(cursor_) + pending_move_, 0, std::max<std::int64_t>(0, last)));
  // The cursor skips the graph below a field.
  if (pending_move_ > 0 && cursor_ < rows.size() && rows[cursor_].name.ends_with(' ') && cursor_ + 1 < rows.size())
    ++cursor_;
  pending_move_ = 0;
  if (cursor_ < rows.size()) marked_name_ = rows[cursor_].name;
  if (marked_name_.ends_with(' ')) marked_name_.pop_back();
  top_ = std::clamp(top_, cursor_ + 1 > visible ? cursor_ + 1 - visible : 0, cursor_);
}

std::vector<std::string> Screen::draw(const Channels& channels, HostTime now, std::size_t columns,
                                      std::size_t rows) {
  const std::vector<Row> all = page_ == Page::kChannels ? channel_rows(channels, now, columns)
                               : page_ == Page::kFields ? field_rows(channels, now, columns)
                                                        : tag_rows(now, columns);
  const std::size_t visible = rows > 4 ? rows - 3 : 1;
  move(all, visible);
  std::vector<std::string> out;
  std::string head;
  switch (page_) {
    case Page::kChannels:
      head = padded("channel", kNameColumns) + "      1/s   bandwidth   gaps  jitter ms p99    age ms         of";
      break;
    case Page::kFields: head = printable(channel_) + ": the newest message"; break;
    case Page::kTags:
      head = std::to_string(all.size()) + " variables" + (all.empty() ? ": requested, none has arrived yet" : "");
      break;
  }
  if (paused_) head += "  (paused)";
  out.push_back(cut(head, columns));
  for (std::size_t i = top_; i < all.size() && i < top_ + visible; ++i) {
    if (i == cursor_) marked_row_ = out.size();
    out.push_back(all[i].text);
  }
  std::string foot = std::to_string(channels.messages()) + " messages";
  if (channels.beyond() > 0)
    foot += ", " + std::to_string(channels.beyond()) + " on channels beyond " + std::to_string(Channels::kMax);
  if (all.size() > visible)
    foot += ", " + std::string(kTitles[static_cast<int>(page_)]) + " " + std::to_string(cursor_ + 1) + " of " +
            std::to_string(all.size());
  out.push_back(cut(foot, columns));
  out.push_back(cut(kKeys, columns));
  return out;
}

}  // namespace tactus::sync::spy
