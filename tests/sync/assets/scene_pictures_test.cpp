// Tests of the pictures of a scene as assets.
#include "sync/assets/scene_pictures.h"

#include <catch2/catch.hpp>
#include <tactus/asset_ref_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>

#include "sync/assets/scene_sender.h"
#include "sync/bus/bus.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

std::int64_t hash_of(const Bytes& bytes) { return fnv1a_64(bytes.data(), bytes.size()); }

}  // namespace

TEST_CASE("Each picture that a material names and that was sent is returned once") {
  const Bytes relief{1, 2, 3}, friction{4, 5}, unused{6};
  constexpr std::int64_t kNeverSent = 12345;
  scene_t scene{};
  scene.step_ns = 1'000'000;
  scene.camera.orientation.w = scene.listener.orientation.w = 1;
  scene.camera_fov_rad = 1;
  for (const auto& [bump, slip] : {std::pair{hash_of(relief), std::int64_t{0}},
                                   {hash_of(relief), hash_of(friction)},
                                   {kNeverSent, hash_of(friction)}}) {
    material_def_t m{};
    m.youngs_modulus_Pa = 1e10;
    m.bump_asset = bump, m.bump_size_u_m = m.bump_size_v_m = 0.1, m.bump_height_m = 0.001;
    m.friction_asset = slip, m.friction_size_u_m = m.friction_size_v_m = 0.1, m.friction_white = 1;
    scene.materials.push_back(m);
  }
  scene.material_count = 3;
  BusOptions options;
  options.memory = true;
  Bus bus(Identity::fresh("test", 1), options);
  SceneReceiver receiver(bus);
  CHECK(pictures_of(receiver).empty());
  SceneSender sender(bus, {{asset_ref_t::SCENE, "scene", encode(scene)},
                           {asset_ref_t::IMAGE, "relief.png", relief},
                           {asset_ref_t::IMAGE, "friction.png", friction},
                           {asset_ref_t::IMAGE, "unused.png", unused}});
  HostTime now = host_time(1);
  for (int ms = 0; ms < 300; ++ms, now += Nanoseconds(1'000'000)) {
    sender.poll(now);
    bus.drain(now);
    receiver.poll(now);
  }
  REQUIRE(receiver.scene());
  CHECK(pictures_of(receiver) == Pictures{{hash_of(relief), relief}, {hash_of(friction), friction}});
}
