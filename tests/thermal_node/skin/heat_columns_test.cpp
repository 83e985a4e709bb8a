#include "thermal_node/skin/heat_columns.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "thermal_node/skin/bioheat_model.h"
#include "thermal_node/skin/contact_model.h"
#include "thermal_node/skin/skin_model.h"

using namespace tactus::thermal;

TEST_CASE("Cell widths grow and fill a thickness exactly") {
  std::array<double, 200> widths;
  for (const double thickness : {1e-6, 0.001, 0.05, 3.0})
    for (const double first : {1e-5, 1e-3}) {
      const std::size_t count = growing_widths(thickness, first, 1.12, widths);
      REQUIRE(count >= 4);
      double sum = 0;
      for (std::size_t i = 0; i < count; ++i) sum += widths[i];
      CHECK(sum == Approx(thickness).epsilon(1e-12));
      CHECK(widths[0] <= first * (1 + 1e-12));
      CHECK(widths[1] == Approx(widths[0] * 1.12));
    }
  CHECK(growing_widths(1, 1e-9, 1.0001, widths) == 0);
  CHECK(growing_widths(0, 1e-3, 1.12, widths) == 0);
  CHECK(growing_widths(std::nan(""), 1e-3, 1.12, widths) == 0);
}

TEST_CASE("Two halves of a pad on one object equal the whole pad on it") {
  const bool layers = GENERATE(true, false);
  const auto skin = [&]() -> std::unique_ptr<Skin> {
    if (layers) return std::make_unique<BioheatModel>(Tissue{layers_of("finger"), 33, 23, 0.0025, 8});
    return std::make_unique<SkinModel>(SkinProperties{});
  };
  // Each half of the pad meets half of the object: its effusivity and the conductance count half.
  const auto whole = skin(), halves = skin();
  whole->set_object({23, 1620, 1.4, 1.95e6});
  for (const std::size_t i : {0, 1}) halves->set_object({23, 810, 0.7, 0.975e6}, i);
  const std::array<double, 2> half{800, 800};
  for (int tick = 0; tick < 200; ++tick) {
    whole->step(0.02, 1600, 1);
    halves->step(0.02, half, 1);
    REQUIRE(halves->surface_degC() == Approx(whole->surface_degC()).epsilon(1e-12));
    REQUIRE(halves->heat_flux_W_m2() == Approx(whole->heat_flux_W_m2()).epsilon(1e-9));
  }
}

TEST_CASE("Heat flows from a warm object through the skin into a cold object and is conserved") {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(0, 1);
  BioheatModel skin({layers_of("finger"), 33, 23, 0.0025, 8});
  for (std::size_t i = 0; i < Skin::kMaxObjects; ++i)
    skin.set_object({10 + 30.0 * static_cast<double>(i), 0, std::pow(10, -1 + 3 * uniform(random)), 2e6, 0.01}, i);
  double skin_J = skin.columns().skin_energy(), objects_J = skin.columns().objects_energy();
  const double all_J = skin_J + objects_J;
  for (int tick = 0; tick < 500; ++tick) {
    std::array<double, Skin::kMaxObjects> h;
    for (double& x : h) x = uniform(random) < 0.4 ? 0 : 2000 * uniform(random);
    skin.step(0.05, h, uniform(random));
    const auto& f = skin.columns().flows();
    skin_J += f.blood_to_skin - f.skin_to_objects - f.skin_to_room;
    objects_J += f.skin_to_objects - f.objects_to_room;
  }
  CHECK(skin.columns().skin_energy() == Approx(skin_J).margin(1e-9 * all_J));
  CHECK(skin.columns().objects_energy() == Approx(objects_J).margin(1e-9 * all_J));
}

TEST_CASE("Skin between an equally pressed warm and cold object has the mean temperature") {
  SkinModel skin({33, 1181, 0, 0});
  skin.set_object({23, 1500}, 0);
  skin.set_object({43, 1500}, 3);
  const std::array<double, 4> h{700, 0, 0, 700};
  for (int tick = 0; tick < 100; ++tick) {
    skin.step(0.02, h, 1);
    REQUIRE(skin.surface_degC() == Approx(33).margin(1e-9));
    REQUIRE(skin.heat_flux_W_m2() == Approx(0).margin(1e-6));
  }
}
