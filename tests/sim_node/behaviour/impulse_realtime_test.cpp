// The step of the impulse solver allocates no memory once its lists have grown. Counts the calls of operator new.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>

#include "tests/sim_node/support/articulated_trees.h"
#include "tests/sim_node/support/toys.h"

namespace {

bool counting = false;
int taken = 0;

void* take(std::size_t size) {
  taken += counting;
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return take(size); }
void* operator new[](std::size_t size) { return take(size); }
// All forms, because a deallocation must match its allocation; sanitizers check it.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size ? size : 1); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size ? size : 1); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }

using namespace tactus::sim;
using namespace tactus::sim::test;

TEST_CASE("A step with bodies, links and impacts allocates no memory after warm-up") {
  Toys toys;
  toys.plane({0, 0, 1}, {0, 0, 0}, 0.5, 0.8);
  // A lever on which balls bounce, and a stack beside it.
  articulated::LinkDef lever;
  lever.joint = JointKind::kRevolute;
  lever.anchor_m = lever.centre_m = {0, 0, 0.1};
  lever.axes[0].axis = {0, 1, 0};
  lever.axes[0].lower = -0.1;
  lever.axes[0].upper = 0.1;
  lever.axes[0].friction = 1e-4;
  lever.mass_kg = 0.2;
  lever.inertia_kg_m2 = Eigen::Vector3d(1e-4, 2e-3, 2e-3).asDiagonal();
  lever.gravity_m_s2 = kDown;
  const int body = add_system(toys.world, articulated::ArticulatedSystem({lever}));
  toys.capsule(body, 0.6, 0.01, {1, 0, 0}, 0.8, 0.8);
  int ball = 0;
  for (int i = 0; i < 3; ++i) ball = toys.ball(0.05, 0.02, {-0.2 + 0.15 * i, 0, 0.2 + 0.1 * i}, 0.5, 0.8);
  for (int i = 0; i < 4; ++i)
    toys.box(0.5, {0.1, 0.1, 0.1}, Eigen::Isometry3d(Eigen::Translation3d(2, 0, 0.05 + 0.11 * i)));
  for (int i = 0; i < 5000; ++i) {
    // All bodies are at rest, with the final number of contacts. Then a ball bounces again.
    if (i == 4000) toys.world.free_body(ball).velocity_m_s.z() = 2;
    toys.collide(0.001);
    counting = i >= 4000;
    toys.solve(0.001);
    counting = false;
  }
  CHECK(taken == 0);
}
