// Tests of decoding: assets and good messages. tests/lcmtypes/ sends hostile bytes of every type.
#include "sync/bus/decode.h"

#include <catch2/catch.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/touch_model_t.hpp>

using namespace tactus;

namespace {
mesh_t triangles(int count) {
  mesh_t m{};
  m.vertex_floats = 9;
  m.positions_m = m.normals = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  for (int i = 0; i < count; ++i) m.indices.insert(m.indices.end(), {0, 1, 2});
  m.index_count = 3 * count;
  return m;
}
}  // namespace

TEST_CASE("An asset may be larger than a datagram") {
  const auto bytes = sync::encode(triangles(10000));
  REQUIRE(bytes.size() > 100'000);
  const auto m = sync::decode_asset<mesh_t>(bytes);
  REQUIRE(m);
  CHECK(m->indices.size() == 30000);
}

TEST_CASE("A mesh whose triangles point outside its vertices is rejected") {
  mesh_t m = triangles(1);
  m.indices[1] = 3;
  CHECK_FALSE(sync::decode_asset<mesh_t>(sync::encode(m)));
  m.indices[1] = -1;
  CHECK_FALSE(sync::decode_asset<mesh_t>(sync::encode(m)));
}

TEST_CASE("An empty buffer is not a valid message") {
  CHECK_FALSE(sync::decode<touch_model_t>(nullptr, 0));
  CHECK_FALSE(sync::decode_asset<scene_t>({}));
}
