#include "sim_node/collision/gaps/feature_contacts.h"

#include "sim_node/collision/gaps/mesh_pair.h"
#include "sim_node/collision/layers/pair_features.h"

namespace tactus::sim::gaps {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using features::FeaturePair;
using features::FeatureTrees;
using features::kDirectionSlack_rad;
using features::MeshFeatures;

// A vertex this far outside a face is over its edge, m: a million times the rounding of a metre.
constexpr double kOnEdge_m = 1e-9;
// Rounding of the prefilter against is_contact(), m.
constexpr double kFilterRounding_m = 1e-12;

bool over_prism(const Vector3d& p, const Triangle& t, double slack_m) {
  for (int j = 0; j < 3; ++j)
    if ((p - t.v[j]).dot(t.inward[j]) < -slack_m) return false;
  return true;
}

// Whether no edge at the vertex is much nearer to the face `height` away than the vertex.
bool nearest_at(const MeshFeatures& mesh, int vertex, const Vector3d& to_foot_m, double height_m) {
  return mesh.nearest(vertex, to_foot_m, nearer_limit_m(height_m, nearer_share(true, false)) - kFilterRounding_m);
}

struct Both {
  const FeatureTrees &a, &b;
  const Isometry3d& b_from_a;
  double above_m, reach_m;
  std::vector<PointPair>& out;

  bool in_range(double gap_m) const { return gap_m > above_m && gap_m <= reach_m; }

  Vector3d vertex_a(int v) const { return b_from_a * a.mesh.vertices[static_cast<std::size_t>(v)]; }
  const Vector3d& vertex_b(int v) const { return b.mesh.vertices[static_cast<std::size_t>(v)]; }
  Vector3d in_a(const Vector3d& v) const { return b_from_a.linear().transpose() * v; }
  static int triangle_of(const MeshFeatures& mesh, int v) {
    return mesh.triangles_at[mesh.first_triangle[static_cast<std::size_t>(v)]];
  }

  void add(const PointPair& p, int triangle_a, int triangle_b) const {
    out.push_back(p);
    out.back().triangle_a = triangle_a, out.back().triangle_b = triangle_b;
  }
  // Adds the pair of two points if both features allow its direction.
  template <class Leaves>
  void add_points(const Vector3d& on_a, const Vector3d& on_b, int triangle_a, int triangle_b,
                  Leaves&& leaves) const {
    PointPair p;
    p.on_a_m = on_a, p.on_b_m = on_b;
    const Vector3d way = on_b - on_a;
    p.gap_m = way.norm();
    if (!in_range(p.gap_m)) return;
    p.normal = way / p.gap_m;
    if (leaves(p.normal)) add(p, triangle_a, triangle_b);
  }

  void vertex_over_face(int v, int face) const {
    const Triangle& t = b.mesh.triangles[static_cast<std::size_t>(face)];
    if (t.normal.isZero()) return;
    const Vector3d p = vertex_a(v);
    const double h = (p - t.v[0]).dot(t.normal);
    if (!in_range(std::abs(h)) || !over_prism(p, t, kOnEdge_m)) return;
    if (!nearest_at(a.mesh, v, in_a(-h * t.normal), std::abs(h))) return;
    add(layer2::over_face(p, t, h, true), a.mesh.triangle_across(v, in_a(t.normal)), face);
  }
  void face_under_vertex(int v, int face) const {
    const Triangle& own = a.mesh.triangles[static_cast<std::size_t>(face)];
    if (own.normal.isZero()) return;
    const Vector3d& p = vertex_b(v);
    const Vector3d seen = in_a(p - b_from_a.translation());
    const double about = std::abs((seen - own.v[0]).dot(own.normal));
    if (about > reach_m + kOnEdge_m || !over_prism(seen, own, 2 * kOnEdge_m)) return;
    const Triangle t = in_frame_of_b(own, b_from_a);
    const double h = (p - t.v[0]).dot(t.normal);
    if (!in_range(std::abs(h)) || !over_prism(p, t, kOnEdge_m)) return;
    if (!nearest_at(b.mesh, v, -h * t.normal, std::abs(h))) return;
    add(layer2::over_face(p, t, h, false), face, b.mesh.triangle_across(v, t.normal));
  }
  void vertex_and_edge(int v, int edge) const {
    const MeshFeatures::Edge& e = b.mesh.edges[static_cast<std::size_t>(edge)];
    const Vector3d p = vertex_a(v), &u = vertex_b(e.ends[0]);
    const double along = (p - u).dot(e.along);
    if (along < -kOnEdge_m || along > e.length_m + kOnEdge_m) return;
    add_points(p, u + std::clamp(along, 0.0, e.length_m) * e.along, triangle_of(a.mesh, v), e.triangle,
               [&](const Vector3d& d) {
                 return e.leaves(-d, kDirectionSlack_rad) && a.mesh.leaves(v, in_a(d), kDirectionSlack_rad);
               });
  }
  void edge_and_vertex(int v, int edge) const {
    const MeshFeatures::Edge& e = a.mesh.edges[static_cast<std::size_t>(edge)];
    const Vector3d &p = vertex_b(v), u = vertex_a(e.ends[0]), way = b_from_a.linear() * e.along;
    const double along = (p - u).dot(way);
    if (along < -kOnEdge_m || along > e.length_m + kOnEdge_m) return;
    add_points(u + std::clamp(along, 0.0, e.length_m) * way, p, e.triangle, triangle_of(b.mesh, v),
               [&](const Vector3d& d) {
                 return e.leaves(in_a(d), kDirectionSlack_rad) && b.mesh.leaves(v, -d, kDirectionSlack_rad);
               });
  }
  void two_vertices(int of_a, int of_b) const {
    add_points(vertex_a(of_a), vertex_b(of_b), triangle_of(a.mesh, of_a), triangle_of(b.mesh, of_b),
               [&](const Vector3d& d) {
                 return a.mesh.leaves(of_a, in_a(d), kDirectionSlack_rad) &&
                        b.mesh.leaves(of_b, -d, kDirectionSlack_rad);
               });
  }
  void two_edges(int of_a, int of_b) const {
    const MeshFeatures::Edge &x = a.mesh.edges[static_cast<std::size_t>(of_a)],
                             &y = b.mesh.edges[static_cast<std::size_t>(of_b)];
    Triangle t;
    for (int i = 0; i < 3; ++i) t.v[i] = b_from_a * a.mesh.triangles[static_cast<std::size_t>(x.triangle)].v[i];
    layer2::between_edges(t, static_cast<std::size_t>(x.side),
                          b.mesh.triangles[static_cast<std::size_t>(y.triangle)], static_cast<std::size_t>(y.side),
                          reach_m, [&](const PointPair& p) {
                            if (p.gap_m > above_m && x.leaves(in_a(p.normal), kDirectionSlack_rad) &&
                                y.leaves(-p.normal, kDirectionSlack_rad))
                              add(p, x.triangle, y.triangle);
                          });
  }
};

}  // namespace

Triangle in_frame_of_b(const Triangle& t, const Isometry3d& b_from_a) {
  Triangle m = moved(t, b_from_a);
  for (int i = 0; i < 3; ++i) m.inward[i] = b_from_a.linear() * t.inward[i];
  return m;
}

void FeatureContacts::find(const FeatureTrees& a, const FeatureTrees& b, const Isometry3d& b_from_a,
                           double above_m, double reach_m, std::vector<PointPair>& out) {
  const Isometry3d a_from_b = b_from_a.inverse(Eigen::Isometry);
  const Both both{a, b, b_from_a, above_m, reach_m, out};
  search_.find(a.vertices, b.faces, b_from_a, reach_m, found_);
  for (const FeaturePair& p : found_) both.vertex_over_face(p.from, p.to);
  search_.find(b.vertices, a.faces, a_from_b, reach_m, found_);
  for (const FeaturePair& p : found_) both.face_under_vertex(p.from, p.to);
  search_.find(a.peaks, b.edges, b_from_a, reach_m, found_);
  for (const FeaturePair& p : found_) both.vertex_and_edge(p.from, p.to);
  search_.find(b.peaks, a.edges, a_from_b, reach_m, found_);
  for (const FeaturePair& p : found_) both.edge_and_vertex(p.from, p.to);
  search_.find(a.peaks, b.peaks, b_from_a, reach_m, found_);
  for (const FeaturePair& p : found_) both.two_vertices(p.from, p.to);
  search_.find_edges(a, b, b_from_a, reach_m, found_);
  for (const FeaturePair& p : found_) both.two_edges(p.from, p.to);
}

}  // namespace tactus::sim::gaps
