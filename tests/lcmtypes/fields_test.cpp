// Tests of reading single fields of encoded messages by their path.
#include "lcmtypes/fields.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <random>
#include <tactus/answer_t.hpp>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_request_t.hpp>
#include <tactus/clock_map_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/degraded_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/frame_shown_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/pass_t.hpp>
#include <tactus/picture_chunk_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/question_t.hpp>
#include <tactus/scene_manifest_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/setting_change_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/sync_report_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tag_values_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/uniform_t.hpp>
#include <tactus/world_state_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"
#include "tests/lcmtypes/samples.h"
#include "tests/lcmtypes/schema.h"
#include "tests/source_dir.h"

using namespace tactus;
using namespace tactus::test;

namespace {

// A list of types besides that of hostile_test: the most frequent ones, arrays of arrays, strings, text.
#define EVERY_KIND                                                                                                \
  world_state_t, contact_frame_t, contact_events_t, touch_model_t, tool_state_t, device_state_t, thermal_state_t, \
      thermal_device_t, presented_t, node_health_t, sync_report_t, clock_map_t, media_clock_t, frame_shown_t,     \
      picture_chunk_t, degradation_t, degraded_t, playout_t, setting_change_t, sim_command_t, sim_reply_t,        \
      game_state_t, log_info_t, scene_manifest_t, asset_request_t, asset_chunk_t, scene_t, mesh_t, \
      tag_list_t, tag_request_t, tag_values_t, question_t, answer_t

const Schema& schema() {
  static const Schema s(source_dir() + "/lcmtypes");
  return s;
}

// Reads a number with the independent reader of the wire format, tests/lcmtypes/schema.h.
double number_at(const std::vector<std::uint8_t>& bytes, const Spot& spot) {
  const auto raw = [&](auto number) {
    std::uint8_t swapped[sizeof number];
    for (std::size_t i = 0; i < sizeof number; ++i) swapped[sizeof number - 1 - i] = bytes.at(spot.offset + i);
    std::memcpy(&number, swapped, sizeof number);
    return static_cast<double>(number);
  };
  if (spot.type == "double") return raw(double{});
  if (spot.type == "float") return raw(float{});
  if (spot.type == "int64_t") return raw(std::int64_t{});
  if (spot.type == "int32_t") return raw(std::int32_t{});
  if (spot.type == "int16_t") return raw(std::int16_t{});
  return raw(std::int8_t{});
}

}  // namespace

TEMPLATE_TEST_CASE("The path of every number finds it, in agreement with an independent parser", "",
                   EVERY_KIND) {
  const std::string type = TestType::getTypeName();
  REQUIRE(message_type(type));
  CHECK(message_type(TestType::getHash())->name == type);
  Samples samples(11);
  for (int round = 0; round < 3; ++round) {
    TestType m{};
    samples.fill(m);
    const auto bytes = sync::encode(m);
    for (const Spot& spot : schema().walk(type, bytes)) {
      const FieldPath path(*message_type(type), spot.path);
      INFO(type << "." << spot.path);
      REQUIRE(path.is_text() == (spot.type == "string"));
      const auto value = path.read(bytes);
      REQUIRE(value);
      if (path.is_text())
        CHECK(static_cast<double>(std::get<std::string>(*value).size()) ==
              number_at(bytes, {spot.path, "int32_t", spot.offset}) - 1);
      else
        CHECK(std::get<double>(*value) == number_at(bytes, spot));
    }
  }
}

TEMPLATE_TEST_CASE(
    "Truncated or corrupted bytes are rejected or read consistently, never beyond their end", "",
    EVERY_KIND) {
  const std::string type = TestType::getTypeName();
  Samples samples(12);
  TestType m{};
  samples.fill(m);
  const auto bytes = sync::encode(m);
  std::vector<FieldPath> paths;
  for (const Spot& spot : schema().walk(type, bytes)) paths.emplace_back(*message_type(type), spot.path);
  std::mt19937 random(5);
  for (int round = 0; round < 40; ++round) {
    std::vector<std::uint8_t> damaged(bytes.begin(),
                                      bytes.begin() + static_cast<std::ptrdiff_t>(random() % bytes.size()));
    for (const FieldPath& path : paths) {
      const auto whole = path.read(bytes), part = path.read(damaged);
      if (part && !path.is_text()) {
        const double a = std::get<double>(*part), b = std::get<double>(*whole);
        CHECK((a == b));  // a complete value is unchanged
      }
    }
    damaged = bytes;
    for (int hits = 0; hits < 8; ++hits)
      damaged[8 + random() % (damaged.size() - 8)] = static_cast<std::uint8_t>(random() % 4 ? 0xff : 0x7f);
    for (const FieldPath& path : paths) path.read(damaged);  // under the address sanitizer this proves it
  }
  std::vector<std::uint8_t> other = bytes;
  other[0] = static_cast<std::uint8_t>(other[0] ^ 1);
  for (const FieldPath& path : paths) CHECK_FALSE(path.read(other));
}

TEMPLATE_TEST_CASE("All numbers and texts of a message are visited in order, each with the path that reads it", "",
                   EVERY_KIND) {
  const std::string name = TestType::getTypeName();
  const MessageType& type = *message_type(name);
  Samples samples(13);
  for (int i = 0; i < 3; ++i) {
    TestType m{};
    samples.fill(m);
    const auto bytes = sync::encode(m);
    const auto spots = schema().walk(name, bytes);
    std::size_t at = 0;
    const bool whole = for_each_leaf(type, bytes, [&](const std::string& path, const Field& field, const Leaf& value) {
      REQUIRE(at < spots.size());
      const Spot& spot = spots[at++];
      INFO(name << "." << spot.path);
      REQUIRE(path == spot.path);
      REQUIRE(field.type == (spot.type == "byte" ? field.type : spot.type));
      if (const auto* text = std::get_if<std::string>(&value))
        CHECK(static_cast<double>(text->size()) == number_at(bytes, {spot.path, "int32_t", spot.offset}) - 1);
      else if (const auto* number = std::get_if<double>(&value))
        CHECK(*number == number_at(bytes, spot));
      else
        CHECK(static_cast<double>(std::get<std::int64_t>(value)) == number_at(bytes, spot));
    });
    CHECK(whole);
    CHECK(at == spots.size());
    // Truncated anywhere, the message is incomplete, and the intact part is visited.
    for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 50) {
      std::size_t visited = 0;
      const std::vector<std::uint8_t> part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
      CHECK_FALSE(for_each_leaf(type, part, [&](const std::string& path, const Field&, const Leaf&) {
        REQUIRE(path == spots[visited++].path);
      }));
      CHECK(visited <= length);
    }
    auto longer = bytes;
    longer.push_back(0);
    CHECK_FALSE(for_each_leaf(type, longer, [](const std::string&, const Field&, const Leaf&) {}));
  }
}

TEST_CASE("A list of fixed length is read like a counted list") {
  pass_t pass{};
  uniform_t u{};
  u.name = "weight", u.count = 3;
  u.values[0] = 1, u.values[1] = 2, u.values[2] = 4, u.values[3] = 8;
  pass.uniforms = {u, u}, pass.uniform_count = 2;
  pass.uniforms[1].values[2] = 16;
  const auto bytes = sync::encode(pass);
  const MessageType& type = *message_type("pass_t");
  CHECK(FieldPath(type, "uniforms[0].values[3]").number(bytes) == 8.0);
  CHECK(FieldPath(type, "uniforms[1].values[2]").number(bytes) == 16.0);
  CHECK_FALSE(FieldPath(type, "uniforms[1].values[4]").number(bytes));
  CHECK_FALSE(FieldPath(type, "uniforms[2].values[0]").number(bytes));
}

TEST_CASE("Every channel carries a described type") {
  CHECK(channel_types().size() >= 30);
  for (const Channel& c : channel_types()) CHECK(message_type(c.type));
  REQUIRE(type_on("TOOL_STATE"));
  CHECK(type_on("TOOL_STATE")->name == "tool_state_t");
  CHECK(type_on("NOTHING") == nullptr);
}

TEST_CASE("A path without a target is rejected with the nearest names") {
  const MessageType& tool = *message_type("tool_state_t");
  const auto sentence = [&](const char* path) -> std::string {
    try {
      const FieldPath p(tool, path);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "accepted";
  };
  CHECK_THAT(sentence("forse_N.z"), Catch::StartsWith("tool_state_t has no field \"forse_N\"; nearest: force_N"));
  CHECK_THAT(sentence("force_N"), Catch::Contains("is not a number; it has x, y, z"));
  CHECK_THAT(sentence("force_N.z.w"), Catch::Contains("has no fields"));
  CHECK_THAT(sentence("constraints.body"), Catch::Contains("give the index, as in constraints[0]"));
  CHECK_THAT(sentence("tool[0]"), Catch::Contains("is not a list"));
  CHECK_THAT(sentence("constraints[-1].body"), Catch::Contains("as a number"));
  CHECK_THAT(sentence("constraints[].body"), Catch::Contains("as a number"));
  CHECK_THAT(sentence(""), Catch::Contains("which field"));
  CHECK(sentence("constraints[3].force_N.x") == "accepted");
}

TEST_CASE("The unit of a variable is in its name, or in that of its parent") {
  const auto unit = [](const char* type, const char* path) { return FieldPath(*message_type(type), path).unit(); };
  CHECK(unit("tool_state_t", "force_N.z") == "N");
  CHECK(unit("tool_state_t", "device_velocity_m_s.x") == "m/s");
  CHECK(unit("tool_state_t", "torque_N_m.x") == "N m");
  CHECK(unit("touch_model_t", "planes[0].stiffness_N_m") == "N/m");
  CHECK(unit("node_health_t", "rate_Hz") == "Hz");
  CHECK(unit("thermal_state_t", "heat_flux_W_m2") == "W/m2");
  CHECK(unit("node_health_t", "ticks").empty());
}
