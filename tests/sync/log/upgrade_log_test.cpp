// Tests of the conversion of logs with renamed message fields.
#include "sync/log/upgrade_log.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstring>
#include <string>
#include <tactus/question_t.hpp>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <vector>

#include "lcmtypes/channels.h"
#include "lcmtypes/fields.h"
#include "sync/bus/decode.h"
#include "sync/log/log_contract.h"
#include "sync/log/log_reader.h"
#include "sync/log/log_writer.h"
#include "sync/log/mapped_log.h"
#include "sync/log/recorder_types.h"
#include "tests/lcmtypes/samples.h"
#include "tests/sync/support/memory_sink.h"
#include "tests/sync/support/temporary_folder.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::int64_t kOldFingerprint = 0x0123456789abcdef;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

std::string hexadecimal(std::int64_t fingerprint) {
  char text[20];
  std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(fingerprint));
  return text;
}

// LOG_TYPES of a release in which tool_state_t had another name for touch_status, and so another fingerprint.
std::vector<std::string> old_types(const std::string& old_field) {
  std::vector<std::string> pages = log_types();
  for (std::string& page : pages) {
    page = replaced(page, hexadecimal(tool_state_t::getHash()), hexadecimal(kOldFingerprint));
    page = replaced(page, "int8_t touch_status", old_field);
  }
  return pages;
}

tool_state_t tool() {
  tool_state_t m{};
  m.header.run_id = m.header.incarnation = 1;
  m.header.sim_time_ns = 5;
  m.device.orientation.w = m.proxy.orientation.w = 1;
  m.touch_status = 2;
  return m;
}

Bytes with_fingerprint(Bytes bytes, std::int64_t fingerprint) {
  for (int i = 7; i >= 0; --i, fingerprint >>= 8) bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(fingerprint);
  return bytes;
}

Bytes old_log(const std::string& old_field, bool with_types = true) {
  Bytes log;
  std::int64_t number = 0;
  const auto text = [](const std::string& s) { return Bytes(s.begin(), s.end()); };
  if (with_types)
    for (const std::string& page : old_types(old_field)) append_event(log, number++, 10, kLogTypes, text(page));
  append_event(log, number++, 20, "FOREIGN", text("a message of another system"));
  append_event(log, number++, 40, channels::kToolState, with_fingerprint(sync::encode(tool()), kOldFingerprint));
  append_event(log, number++, 30, "SHORT", text("abc"));
  return log;
}

struct Result {
  UpgradeCounts counts;
  Bytes bytes;
};
Result upgraded(const Bytes& log) {
  const auto state = std::make_shared<MemorySink::State>();
  Result r{upgrade_log(log, std::make_unique<MemorySink>(state)), {}};
  r.bytes = state->bytes;
  return r;
}

}  // namespace

TEST_CASE("A log with renamed fields is converted to messages that this release decodes") {
  const Result result = upgraded(old_log("int8_t touch_how"));
  CHECK(result.counts.converted == 1);
  CHECK(result.counts.damaged_regions == 0);
  CHECK(recorded_types(result.bytes).size() == message_types().size());
  CHECK(renamed_types(recorded_types(result.bytes)).empty());
  std::vector<LogEvent> messages;
  for (const LogEvent& e : read_all(result.bytes))
    if (e.channel != kLogTypes) messages.push_back(e);
  REQUIRE(messages.size() == 3);
  const auto state = decode<tool_state_t>(messages[1].data.data(), messages[1].data.size());
  REQUIRE(state);
  CHECK(state->touch_status == 2);
}

namespace {

template <class Number>
void append_number(Bytes& out, Number value) {
  Bytes raw(sizeof value);
  std::memcpy(raw.data(), &value, sizeof value);
  out.insert(out.end(), raw.rbegin(), raw.rend());  // big-endian
}
void append_vector(Bytes& out, const vec3f_t& v) { append_number(out, v.x), append_number(out, v.y), append_number(out, v.z); }
void append_vector(Bytes& out, const vec3_t& v) { append_number(out, v.x), append_number(out, v.y), append_number(out, v.z); }
vec3f_t single(const vec3_t& v) {
  vec3f_t f{};
  f.x = static_cast<float>(v.x), f.y = static_cast<float>(v.y), f.z = static_cast<float>(v.z);
  return f;
}

// Messages of the release in which cumulative impulses had single precision. The changed lists are the last fields.
constexpr std::size_t kConstraintBytes = 80, kAppliedBytes = 40;
Bytes in_single_precision(const tool_state_t& m) {
  Bytes bytes = with_fingerprint(sync::encode(m), kOldFingerprint);
  bytes.resize(bytes.size() - kConstraintBytes * m.constraints.size());
  for (const tool_constraint_t& c : m.constraints) {
    append_number(bytes, c.contact_id), append_number(bytes, c.body);
    append_vector(bytes, c.point_m), append_vector(bytes, c.force_N), append_vector(bytes, single(c.impulse_N_s));
  }
  return bytes;
}
Bytes in_single_precision(const touch_model_t& m) {
  Bytes bytes = with_fingerprint(sync::encode(m), kOldFingerprint + 1);
  bytes.resize(bytes.size() - kAppliedBytes * m.applied.size());
  for (const touch_applied_t& a : m.applied)
    append_number(bytes, a.contact_id), append_vector(bytes, single(a.impulse_N_s)), append_number(bytes, static_cast<float>(a.energy_J));
  return bytes;
}

std::string replaced_everywhere(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size()) text.replace(at, from.size(), to);
  return text;
}

std::vector<std::string> types_in_single_precision() {
  std::vector<std::string> pages = log_types();
  for (std::string& page : pages) {
    page = replaced(page, hexadecimal(tool_state_t::getHash()), hexadecimal(kOldFingerprint));
    page = replaced(page, hexadecimal(touch_model_t::getHash()), hexadecimal(kOldFingerprint + 1));
    page = replaced(page, hexadecimal(tool_constraint_t::getHash()), hexadecimal(kOldFingerprint + 2));
    page = replaced(page, hexadecimal(touch_applied_t::getHash()), hexadecimal(kOldFingerprint + 3));
    page = replaced_everywhere(page, "  vec3_t impulse_N_s\n", "  vec3f_t impulse_N_s\n");
    page = replaced(page, "  double energy_J\n", "  float energy_J\n");
    page = replaced(page, "  int64_t impulse_since_ns\n", "");
  }
  return pages;
}

}  // namespace

TEST_CASE("A log with impulses of single precision is converted with the same values, and an unknown begin of the sums") {
  test::Samples samples(8);
  std::vector<tool_state_t> tools(40);
  std::vector<touch_model_t> models(40);
  Bytes log;
  std::int64_t number = 0;
  for (const std::string& page : types_in_single_precision()) append_event(log, number++, 10, kLogTypes, Bytes(page.begin(), page.end()));
  for (std::size_t i = 0; i < tools.size(); ++i) {
    samples.fill(tools[i]), samples.fill(models[i]);
    append_event(log, number++, 20, channels::kToolState, in_single_precision(tools[i]));
    append_event(log, number++, 20, channels::kTouchModel, in_single_precision(models[i]));
    Bytes damaged = in_single_precision(models[i]);
    damaged.resize(damaged.size() - 1 - i);
    append_event(log, number++, 20, channels::kTouchModel, damaged);
  }
  const Result result = upgraded(log);
  CHECK(result.counts.converted == 80);
  std::vector<LogEvent> out;
  for (const LogEvent& e : read_all(result.bytes))
    if (e.channel != kLogTypes) out.push_back(e);
  REQUIRE(out.size() == 120);
  for (std::size_t i = 0; i < tools.size(); ++i) {
    // The oracle: the message of this release, with rounded sums.
    for (tool_constraint_t& c : tools[i].constraints) {
      const vec3f_t f = single(c.impulse_N_s);
      c.impulse_N_s.x = f.x, c.impulse_N_s.y = f.y, c.impulse_N_s.z = f.z;
      c.impulse_since_ns = 0;
    }
    for (touch_applied_t& a : models[i].applied) {
      const vec3f_t f = single(a.impulse_N_s);
      a.impulse_N_s.x = f.x, a.impulse_N_s.y = f.y, a.impulse_N_s.z = f.z;
      a.energy_J = static_cast<float>(a.energy_J);
    }
    CHECK(Bytes(out[3 * i].data.begin(), out[3 * i].data.end()) == sync::encode(tools[i]));
    CHECK(Bytes(out[3 * i + 1].data.begin(), out[3 * i + 1].data.end()) == sync::encode(models[i]));
    CHECK_FALSE(decode<touch_model_t>(out[3 * i + 2].data.data(), out[3 * i + 2].data.size()));
  }
}

TEST_CASE("A question of a log from before pages and hints is converted to one page without a hint") {
  test::Samples samples(9);
  question_t question{};
  samples.fill(question);
  question.hint.clear(), question.page = question.pages = 0;
  Bytes log, before = with_fingerprint(sync::encode(question), kOldFingerprint);
  constexpr std::size_t kHintAndPages = 5 + 4 + 4;  // the last fields
  before.resize(before.size() - kHintAndPages);
  for (const std::string& page : log_types()) {
    std::string old = replaced(page, hexadecimal(question_t::getHash()), hexadecimal(kOldFingerprint));
    old = replaced(old, "  string progress\n  string hint\n  int32_t page\n  int32_t pages\n", "  string progress\n");
    append_event(log, 0, 10, kLogTypes, Bytes(old.begin(), old.end()));
  }
  append_event(log, 1, 20, channels::kQuestion, before);
  const Result result = upgraded(log);
  CHECK(result.counts.converted == 1);
  for (const LogEvent& e : read_all(result.bytes))
    if (e.channel == channels::kQuestion) {
      CHECK(Bytes(e.data.begin(), e.data.end()) == sync::encode(question));
      CHECK(decode<question_t>(e.data.data(), e.data.size()));
    }
}

TEST_CASE("A log that describes a type twice is refused, because the descriptions may differ") {
  const std::string struct_line = "struct tool_constraint_t ", other = "struct touch_applied_t " + hexadecimal(kOldFingerprint) + "\n";
  // The first description has no fields: the numbers of those of the second lie beyond it.
  for (const std::string& added : {struct_line + hexadecimal(tool_constraint_t::getHash()) + "\n", struct_line + "0x1\n", other}) {
    Bytes log;
    std::int64_t number = 0;
    for (const std::string& page : types_in_single_precision()) {
      const std::string text = replaced(page, struct_line, added + struct_line);
      append_event(log, number++, 10, kLogTypes, Bytes(text.begin(), text.end()));
    }
    tool_state_t m = tool();
    m.constraints.resize(3);
    m.constraint_count = 3;
    append_event(log, number++, 20, channels::kToolState, in_single_precision(m));
    CHECK_THROWS_AS(upgraded(log), std::runtime_error);
  }
}

TEST_CASE("A conversion keeps channels, stamps, order and all other bytes") {
  const Bytes log = old_log("int8_t touch_how");
  const Result result = upgraded(log);
  std::vector<LogEvent> before, after;
  for (const LogEvent& e : read_all(log))
    if (e.channel != kLogTypes) before.push_back(e);
  for (const LogEvent& e : read_all(result.bytes))
    if (e.channel != kLogTypes) after.push_back(e);
  REQUIRE(after.size() == before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    CHECK(after[i].channel == before[i].channel);
    CHECK(after[i].timestamp_us == before[i].timestamp_us);
    const std::size_t from = before[i].channel == channels::kToolState ? 8 : 0;
    CHECK(Bytes(after[i].data.begin() + static_cast<std::ptrdiff_t>(from), after[i].data.end()) ==
          Bytes(before[i].data.begin() + static_cast<std::ptrdiff_t>(from), before[i].data.end()));
  }
}

TEST_CASE("A log with other fields than renamed ones is refused with the name of the type") {
  CHECK_THROWS_WITH(upgraded(old_log("int8_t unknown_field")), Catch::Contains("tool_state_t") && Catch::Contains("other fields"));
  CHECK_THROWS_WITH(upgraded(old_log("int32_t touch_how")), Catch::Contains("tool_state_t"));
  CHECK_THROWS_WITH(upgraded(old_log("", false)), Catch::Contains("LOG_TYPES"));
}

TEST_CASE("A reader refuses a log with renamed fields and names the command that converts it") {
  const TemporaryFolder folder;
  const std::string path = (folder.path / "old.lcmlog").string();
  REQUIRE(FileSink(path).append(old_log("int8_t touch_how")).empty());
  CHECK_THROWS_WITH(MappedLog(path), Catch::Contains("tool_state_t") && Catch::Contains("tactus log upgrade " + path));
  CHECK_NOTHROW(MappedLog(path, LogTypes::kAny));
  const std::string converted = (folder.path / "new.lcmlog").string();
  REQUIRE(FileSink(converted).append(upgraded(old_log("int8_t touch_how")).bytes).empty());
  CHECK_NOTHROW(MappedLog(converted));
}

TEST_CASE("A reader refuses a log of another release that has no intact description of its types") {
  const TemporaryFolder folder;
  const auto path_of = [&](const char* name, int old_messages, int current_messages) {
    Bytes log;
    std::int64_t number = 0;
    for (int i = 0; i < old_messages; ++i)
      append_event(log, number++, i, channels::kToolState, with_fingerprint(sync::encode(tool()), kOldFingerprint));
    for (int i = 0; i < current_messages; ++i) append_event(log, number++, i, channels::kToolState, sync::encode(tool()));
    const std::string path = (folder.path / name).string();
    REQUIRE(FileSink(path).append(log).empty());
    return path;
  };
  CHECK_THROWS_WITH(MappedLog(path_of("old.lcmlog", 50, 0)), Catch::Contains("another release on TOOL_STATE"));
  CHECK_NOTHROW(MappedLog(path_of("damaged.lcmlog", 50, 1)));
  CHECK_NOTHROW(MappedLog(path_of("short.lcmlog", 5, 0)));
  CHECK_NOTHROW(MappedLog(path_of("current.lcmlog", 0, 50)));
}
