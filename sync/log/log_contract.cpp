#include "sync/log/log_contract.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "lcmtypes/fields.h"
#include "sync/log/log_header.h"
#include "sync/log/log_reader.h"
#include "sync/log/recorder_types.h"

namespace tactus::sync {
namespace {

// LOG_TYPES follows LOG_INFO at the start of each part of a recording. Design: room for other leading events.
constexpr int kHeadEvents = 1024;
// Without LOG_TYPES. Design: a few seconds of a run; more damaged messages in a row on one channel are not plausible.
constexpr int kSearchedEvents = 50'000;
constexpr int kMinMessages = 20;

struct RenamedField {
  std::string_view type, before, now;
};
// Fields that were renamed since 0.1.0, each with its message type.
constexpr std::array<RenamedField, 5> kRenamedFields{{{"modality_report_t", "owed", "expected"},
                                                      {"tool_state_t", "touch_how", "touch_status"},
                                                      {"decision_t", "why", "drop_reason"},
                                                      {"node_health_t", "owes", "expected_events"},
                                                      {"node_health_t", "note", "status_text"}}};

struct AddedField {
  std::string_view type, name;
};
// Fields that did not exist in 0.1.0 and for which 0, or an empty text, means that the value is not known.
constexpr std::array<AddedField, 5> kAddedFields{
    {{"tool_constraint_t", "impulse_since_ns"}, {"tool_state_t", "injected_J"}, {"question_t", "hint"},
      {"question_t", "page"}, {"question_t", "pages"}}};

std::string_view new_name(std::string_view type, std::string_view name) {
  for (const RenamedField& r : kRenamedFields)
    if (r.type == type && r.before == name) return r.now;
  return name;
}

// Whether every value of a recorded type is a value of the type that a field has now.
bool holds_values_of(std::string_view now, std::string_view before) {
  return now == before || (now == "double" && before == "float") || (now == "vec3_t" && before == "vec3f_t");
}

bool is_added(std::string_view type, std::string_view name) {
  return std::any_of(kAddedFields.begin(), kAddedFields.end(), [&](const AddedField& a) { return a.type == type && a.name == name; });
}

// The text of all pages, without their titles; empty when one is missing.
std::string all_pages(std::span<const std::uint8_t> log) {
  LogScanner scanner(log);
  LogEvent e;
  std::string text;
  int last = 0;
  for (int n = 0; n < kHeadEvents && scanner.next(e); ++n) {
    if (e.channel != kLogTypes) continue;
    const std::string_view page(reinterpret_cast<const char*>(e.data.data()), e.data.size());
    const std::size_t end_of_title = page.find('\n');
    int number = 0, pages = 0;
    if (end_of_title == page.npos ||
        std::sscanf(std::string(page.substr(0, end_of_title)).c_str(), "tactus types, page %d of %d", &number, &pages) != 2 ||
        number != ++last)
      return {};
    text += page.substr(end_of_title + 1);
    if (number == pages) return text;
  }
  return {};
}

// A channel of this system on which no message has the present type, although at least kMinMessages were found: their type has
// changed. Single messages can be damaged. Empty: there is none.
std::string channel_of_another_type(std::span<const std::uint8_t> log) {
  struct Count {
    int messages = 0, current = 0;
  };
  std::map<std::string, Count> counts;
  LogScanner scanner(log);
  LogEvent e;
  for (int n = 0; n < kSearchedEvents && scanner.next(e); ++n) {
    const MessageType* expected = type_on(e.channel);
    if (!expected || !peek_header(e.data.data(), e.data.size())) continue;  // else of another system
    Count& count = counts[std::string(e.channel)];
    ++count.messages;
    count.current += type_of(e.data) == expected;
  }
  for (const auto& [channel, count] : counts)
    if (count.messages >= kMinMessages && count.current == 0) return channel;
  return {};
}

}  // namespace

std::vector<RecordedType> recorded_types(std::span<const std::uint8_t> log) {
  std::vector<RecordedType> types;
  std::istringstream lines(all_pages(log));
  for (std::string line; std::getline(lines, line);) {
    std::array<char, 128> name{};
    unsigned long long fingerprint = 0;
    if (std::sscanf(line.c_str(), "struct %127s 0x%llx", name.data(), &fingerprint) == 2)
      types.push_back({name.data(), static_cast<std::int64_t>(fingerprint), {}});
    else if (line.starts_with("  ") && !types.empty())
      types.back().fields.push_back(line.substr(2));
  }
  return types;
}

RecordedField parse_field(std::string_view line) {
  const std::size_t space = std::min(line.find(' '), line.size());
  const std::size_t begin = std::min(space + 1, line.size()), bracket = std::min(line.find('[', begin), line.size());
  std::string_view count = line.substr(std::min(bracket + 1, line.size()));
  if (!count.empty()) count.remove_suffix(1);
  return {line.substr(0, space), line.substr(begin, bracket - begin), count};
}

std::optional<std::vector<int>> matching_fields(const RecordedType& recorded, const MessageType& now) {
  std::vector<int> places;
  std::size_t next = 0;
  for (const Field& f : now.fields) {
    const RecordedField before = next < recorded.fields.size() ? parse_field(recorded.fields[next]) : RecordedField{};
    const bool same = new_name(recorded.name, before.name) == f.name && new_name(recorded.name, before.count) == f.count &&
                      holds_values_of(f.type, before.type);
    if (same)
      places.push_back(static_cast<int>(next++));
    else if (is_added(recorded.name, f.name))
      places.push_back(-1);
    else
      return std::nullopt;
  }
  return next == recorded.fields.size() ? std::optional(places) : std::nullopt;
}

std::map<std::int64_t, std::int64_t> renamed_types(const std::vector<RecordedType>& recorded) {
  std::map<std::int64_t, std::int64_t> renamed;
  for (const RecordedType& type : recorded) {
    const MessageType* now = message_type(type.name);
    if (now && now->fingerprint == type.fingerprint) continue;
    if (!now || !matching_fields(type, *now))
      throw std::runtime_error("has messages of the type " + type.name + " with other fields than this release; " +
                               "use the release that LOG_INFO of the log names");
    renamed[type.fingerprint] = now->fingerprint;
  }
  return renamed;
}

void require_current_types(std::span<const std::uint8_t> log, const std::string& path) {
  const auto changed = [](const RecordedType& type) {
    const MessageType* now = message_type(type.name);
    return !now || now->fingerprint != type.fingerprint;
  };
  const std::vector<RecordedType> types = recorded_types(log);
  if (const std::string channel = types.empty() ? channel_of_another_type(log) : ""; !channel.empty())
    throw std::runtime_error(path + " has messages of another release on " + channel + ", and no intact LOG_TYPES to convert it by; " +
                             "read it with the release that recorded it");
  const auto first = std::find_if(types.begin(), types.end(), changed);
  if (first == types.end()) return;
  throw std::runtime_error(path + " was recorded with an earlier form of the message type " + first->name +
                           "; convert it: tactus log upgrade " + path + " NEW.lcmlog");
}

}  // namespace tactus::sync
