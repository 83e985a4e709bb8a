#include "sim_node/collision/layers/mesh_contact.h"

#include <stdexcept>

namespace tactus::sim {
namespace {

Triangle moved(const Triangle& t, const Eigen::Isometry3d& motion) {
  Triangle m;
  for (int i = 0; i < 3; ++i) {
    m.v[i] = motion * t.v[i];
    m.inward[i] = motion.linear() * t.inward[i];
  }
  m.normal = motion.linear() * t.normal;
  return m;
}

void to_world(const Eigen::Isometry3d& pose, PointPair& p) {
  p.on_a_m = pose * p.on_a_m;
  p.on_b_m = pose * p.on_b_m;
  p.normal = pose.linear() * p.normal;
}

}  // namespace

ContactMesh::ContactMesh(std::span<const Eigen::Vector3d> vertices, std::span<const int> indices)
    : tree(vertices, indices), check(check_mesh(vertices, indices)) {}

MeshContact::MeshContact(const MeshContactOptions& options) : options_(options), layer1_(options.isa) {}

void MeshContact::check_supported(const ContactMesh& a, const ContactMesh& b) const {
  if (options_.remover != DuplicateRemover::kAdjacency) return;
  for (const ContactMesh* m : {&a, &b})
    if (!m->check.well_constructed())
      throw std::runtime_error(
          "sim_node: the duplicate remover by adjacency needs closed meshes with correct adjacency, but in one mesh " +
          m->check.fault + "; choose the hashed remover or repair the mesh");
}

void MeshContact::query(const ContactMesh& a, const Eigen::Isometry3d& pose_a, const ContactMesh& b,
                        const Eigen::Isometry3d& pose_b, const Reach& reach, MeshContactResult& out) {
  out.pairs.clear();
  out.pierced = false;
  layer1_.find(a.tree, pose_a, b.tree, pose_b, reach.tolerance_m, leaves_);
  out.leaf_pairs = leaves_.size();
  // In the frame of b, so that only the triangles of a need a transform.
  const Eigen::Isometry3d b_from_a = pose_b.inverse() * pose_a;
  Triangle ta;
  int last = -1;
  for (const auto& [i, j] : leaves_) {
    if (i != last) ta = moved(a.tree.triangles()[static_cast<std::size_t>(i)], b_from_a);
    last = i;
    const Triangle& tb = b.tree.triangles()[static_cast<std::size_t>(j)];
    const std::size_t first = out.pairs.size();
    if (options_.mode == ContactMode::kComplete)
      complete_contact(ta, tb, reach, out.pairs);
    else
      itouch2005_contact(ta, tb, reach, out.pairs);
    for (std::size_t k = first; k < out.pairs.size(); ++k) {
      PointPair& p = out.pairs[k];
      p.triangle_a = i, p.triangle_b = j;
      out.pierced |= p.pierced;
    }
  }
  out.raw_pairs = out.pairs.size();
  switch (options_.remover) {
    case DuplicateRemover::kHashed: layer3_.remove_hashed(out.pairs); break;
    case DuplicateRemover::kBruteForce: Duplicates::remove_brute_force(out.pairs); break;
    case DuplicateRemover::kAdjacency: layer3_.remove_adjacent(a.check, b.check, out.pairs); break;
  }
  for (PointPair& p : out.pairs) to_world(pose_b, p);
}

}  // namespace tactus::sim
