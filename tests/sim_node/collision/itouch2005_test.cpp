#include "tests/sim_node/support/contact_check.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

Triangle one(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const std::vector<Vector3d> v{a, b, c};
  const std::vector<int> i{0, 1, 2};
  return ObbTree(v, i).triangles()[0];
}

// I-Touch's example: tolerance 10, margin 2.
constexpr Reach kExample{10, 2};

std::vector<PointPair> contact_of(const Triangle& a, const Triangle& b, const Reach& reach = kExample) {
  std::vector<PointPair> out;
  itouch2005_contact(a, b, reach, out);
  return out;
}

}  // namespace

TEST_CASE("Vertices with gaps of 11, 5 and 6 and a margin of 2 are an edge-plane contact") {
  const ActiveVertices active = active_vertices({11, 5, 6}, kExample);
  CHECK(active.count == 2);
  CHECK_FALSE(active.vertex[0]);
  CHECK(active.vertex[1]);
  CHECK(active.vertex[2]);
  CHECK(active_vertices({5, 6, 7}, kExample).count == 3);
  CHECK(active_vertices({5, 8, 9}, kExample).count == 1);
  CHECK(active_vertices({9, 10, 11}, kExample).count == 2);
  CHECK(active_vertices({11, 12, 13}, kExample).count == 0);

  // The same with triangles: one over a large one, at these heights. Two vertices, two pairs, an edge.
  const Triangle floor = one({-100, -100, 0}, {100, -100, 0}, {0, 200, 0});
  for (const bool reversed : {false, true}) {
    const Vector3d u(0, 20, 11), v(-10, 0, 5), w(10, 0, 6);
    const auto found = contact_of(reversed ? one(w, v, u) : one(u, v, w), floor);
    REQUIRE(found.size() == 2);
    for (const PointPair& p : found) {
      CHECK(p.kind == ContactKind::kEdge);
      CHECK(p.on_b_m.z() == Approx(0).margin(1e-12));
      CHECK((p.on_a_m - p.on_b_m).norm() == Approx(p.gap_m));
      CHECK(p.normal.z() == Approx(-1));
    }
    CHECK(found[0].gap_m + found[1].gap_m == Approx(11));
  }
}

TEST_CASE("A plane-plane contact is a surface, a single vertex a point, crossing edges a point between them") {
  const Triangle floor = one({-100, -100, 0}, {100, -100, 0}, {0, 200, 0});
  const auto flat = contact_of(one({0, 20, 5}, {-10, 0, 5}, {10, 0, 6}), floor);
  REQUIRE(flat.size() == 3);
  CHECK(flat[0].kind == ContactKind::kSurface);
  const auto tip = contact_of(one({0, 0, 5}, {-10, 0, 15}, {10, 0, 16}), floor);
  REQUIRE(tip.size() == 1);
  CHECK(tip[0].kind == ContactKind::kPoint);
  // Two roofs, ridge across ridge, 4 apart: no vertex lies over the other.
  const auto ridges =
      contact_of(one({-50, 0, 4}, {50, 0, 4}, {0, 0, 60}), one({0, -50, 0}, {0, 50, 0}, {0, 0, -60}));
  REQUIRE(ridges.size() == 1);
  CHECK(ridges[0].kind == ContactKind::kPoint);
  CHECK(ridges[0].gap_m == Approx(4));
}

TEST_CASE("The I-Touch mode misses a piercing edge as its authors state, the complete mode reports it") {
  const Triangle floor = one({-100, -100, 0}, {100, -100, 0}, {0, 200, 0}),
                 spike = one({0, 0, -50}, {5, 0, 60}, {-5, 0, 60});
  CHECK(contact_of(spike, floor).empty());
  std::vector<PointPair> complete;
  complete_contact(spike, floor, kExample, complete);
  CHECK(std::any_of(complete.begin(), complete.end(), [](const PointPair& p) { return p.pierced; }));
}

TEST_CASE("The I-Touch mode finds no false pair and most true ones") {
  const Soup a = lumpy_sphere(4, 0.1, 1), b = lumpy_sphere(4, 0.1, 2);
  const ContactMesh ma(a.vertices, a.indices), mb(b.vertices, b.indices);
  MeshContact contact({.mode = ContactMode::kItouch2005});
  MeshContactResult found;
  Random random(21);
  int near = 0, missed = 0, uncovered = 0;
  std::vector<PointPair> alone;
  for (int i = 0; i < 6; ++i) {
    const Isometry3d pose = placed_near(ma, mb, random, 0.3, 3e-4);
    const Reach reach{1e-3, 1e-4};
    contact.query(ma, Isometry3d::Identity(), mb, pose, reach, found);
    const Placed pa(a, Isometry3d::Identity()), pb(b, pose);
    const Truth truth = compare(pa, pb, reach.tolerance_m, found);
    check_sound(pa, pb, reach.tolerance_m, found);
    CHECK(truth.near > 0);
    near += truth.near;
    uncovered += truth.missed;
    // Each pair of triangles separately.
    for (std::size_t k = 0; k < pa.triangles.size(); ++k)
      for (std::size_t l = 0; l < pb.triangles.size(); ++l) {
        if (pa.boxes[k].squaredExteriorDistance(pb.boxes[l]) > 1e-6 ||
            exact_distance(pa.triangles[k], pb.triangles[l]) > 1e-3 - 1e-9)
          continue;
        alone.clear();
        const Corners &t = pa.triangles[k], &u = pb.triangles[l];
        itouch2005_contact(one(t[0], t[1], t[2]), one(u[0], u[1], u[2]), reach, alone);
        missed += alone.empty();
      }
  }
  INFO(missed << " of " << near << " missed, " << uncovered << " not covered by their neighbours either");
  // I-Touch misses some pairs: where a vertex over a face hides near edges, or an active vertex lies outside the
  // prism. About 15 % at this margin.
  CHECK(missed > 0);
  CHECK(missed < 0.25 * near);
  CHECK(uncovered <= missed);
}
