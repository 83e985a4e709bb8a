#include "sim_node/collision/sphere_tree.h"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/sim_node/support/meshes.h"

using namespace tactus::sim;
using namespace tactus::sim::test;

TEST_CASE("The sphere tree finds the same spheres as an exhaustive search, and always the unbounded ones") {
  for (const int count : {0, 1, 2, 3, 500}) {
    Random random(3);
    std::vector<SphereTree::Sphere> all;
    for (int i = 0; i < count; ++i)
      all.push_back({uniform(random, 0, 1) * direction(random),
                     i % 50 == 7 ? std::numeric_limits<double>::infinity() : uniform(random, 0, 0.1), i});
    const SphereTree tree(all);
    int found = 0;
    for (int k = 0; k < 200; ++k) {
      const Eigen::Vector3d place = 1.2 * uniform(random, 0, 1) * direction(random);
      const double reach = uniform(random, 0, 0.2);
      std::vector<int> out, expected;
      tree.near(place, reach, out);
      std::sort(out.begin(), out.end());
      for (const auto& s : all)
        if ((place - s.centre_m).norm() <= s.radius_m + reach) expected.push_back(s.id);
      CHECK(out == expected);
      found += static_cast<int>(out.size());
    }
    CHECK((found > 100 || count < 500));
  }
}
