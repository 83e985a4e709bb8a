#include "sim_node/collision/features/feature_search.h"

#include <bit>

namespace tactus::sim::features {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3f;

// Rounding of a test in float per metre of the coordinates, as in LeafPairs.
constexpr double kFloatRounding = 4e-6;
constexpr unsigned kAllLanes = (1u << kLanes) - 1;

void store(const Vector3f& v, float* to) {
  for (int k = 0; k < 3; ++k) to[k] = v[k];
}

}  // namespace

FeatureSearch::FeatureSearch(Isa isa)
    : reach_(isa == Isa::kAvx512 ? reach_avx512
             : isa == Isa::kAvx2 ? reach_avx2
                                 : reach_baseline),
      cross_(isa == Isa::kAvx512 ? cross_avx512
             : isa == Isa::kAvx2 ? cross_avx2
                                 : cross_baseline) {}

bool FeatureSearch::start(const FeatureTree& from, const FeatureTree& to, const Isometry3d& to_from,
                          double reach_m, std::vector<FeaturePair>& out) {
  out.clear();
  if (from.empty() || to.empty()) return false;
  const Eigen::Vector3d shift = to_from * from.origin() - to.origin();
  const double size = from.radius_m() + to.radius_m() + reach_m, apart = shift.norm();
  if (apart > size) return false;
  from_ = &from, to_ = &to;
  rotation_ = to_from.linear().cast<float>();
  shift_ = shift.cast<float>();
  reach_m_ = static_cast<float>(reach_m);
  slack_m_ = static_cast<float>(kFloatRounding * (apart + size));
  out_ = &out;
  list_.clear();
  list_.push_back({0, 1});
  return true;
}

void FeatureSearch::find(const FeatureTree& from, const FeatureTree& to, const Isometry3d& to_from, double reach_m,
                         std::vector<FeaturePair>& out) {
  edges_from_ = edges_to_ = nullptr;
  if (start(from, to, to_from, reach_m, out)) descend(0, 0, 1);
}

void FeatureSearch::find_edges(const FeatureTrees& from, const FeatureTrees& to, const Isometry3d& to_from,
                               double reach_m, std::vector<FeaturePair>& out) {
  edges_from_ = &from, edges_to_ = &to;
  if (start(from.edges, to.edges, to_from, reach_m, out)) descend(0, 0, 1);
}

FeatureQuery FeatureSearch::query_of(const FeatureNode& n, int lane) const {
  FeatureQuery q;
  store(rotation_ * Vector3f(n.centre[0][lane], n.centre[1][lane], n.centre[2][lane]) + shift_, q.centre);
  store(rotation_ * Vector3f(n.cone[0][lane], n.cone[1][lane], n.cone[2][lane]), q.cone);
  q.cosine = n.cosine[lane], q.sine = n.sine[lane];
  q.size = n.size[lane];
  q.reach = reach_m_, q.slack = slack_m_;
  const bool leaf = n.child[lane] < 0;
  q.radius = leaf ? 0 : q.size;
  Vector3f along = Vector3f::Zero();
  // The box of a segment has an extent along one axis only.
  for (int i = 0; leaf && i < 3; ++i)
    along += n.half[i][lane] * Vector3f(n.axis[i][0][lane], n.axis[i][1][lane], n.axis[i][2][lane]);
  store(rotation_ * along, q.along);
  return q;
}

// Adds the parts of the entry that may meet the query to the list.
void FeatureSearch::refine(Entry entry, const FeatureQuery& query, bool leaf) {
  const FeatureNode& n = to_->nodes()[static_cast<std::size_t>(entry.node)];
  const unsigned hit = reach_(n, query) & entry.lanes;
  unsigned keep = hit & ~n.inner;
  for (unsigned inner = hit & n.inner; inner; inner &= inner - 1) {
    const int lane = std::countr_zero(inner);
    if (leaf || n.size[lane] > query.size)
      refine({n.child[lane], kAllLanes}, query, leaf);
    else
      keep |= 1u << lane;
  }
  if (keep) list_.push_back({entry.node, keep});
}

void FeatureSearch::descend(int node, std::size_t first, std::size_t last) {
  const FeatureNode& n = from_->nodes()[static_cast<std::size_t>(node)];
  for (int lane = 0; lane < n.count; ++lane) {
    const FeatureQuery query = query_of(n, lane);
    const std::size_t begin = list_.size();
    const bool leaf = n.child[lane] < 0;
    for (std::size_t i = first; i < last; ++i) refine(list_[i], query, leaf);
    if (list_.size() == begin) continue;
    if (leaf)
      emit(n, lane, begin);
    else
      descend(n.child[lane], begin, list_.size());
    list_.resize(begin);
  }
}

void FeatureSearch::emit(const FeatureNode& node, int lane, std::size_t first) {
  const int from = ~node.child[lane];
  EdgeQuery query;
  if (edges_from_) {
    const MeshFeatures::Edge& e = edges_from_->mesh.edges[static_cast<std::size_t>(from)];
    store(rotation_ * Vector3f(node.centre[0][lane], node.centre[1][lane], node.centre[2][lane]) + shift_,
          query.centre);
    store(rotation_ * e.along.cast<float>(), query.along);
    for (int side = 0; side < 2; ++side) store(rotation_ * e.inward[side].cast<float>(), query.inward[side]);
    query.half = static_cast<float>(e.length_m / 2);
    query.reach = reach_m_, query.slack = slack_m_;
  }
  for (std::size_t i = first; i < list_.size(); ++i) {
    const auto at = static_cast<std::size_t>(list_[i].node);
    const FeatureNode& n = to_->nodes()[at];
    unsigned lanes = list_[i].lanes;
    if (edges_from_) lanes &= cross_(n, edges_to_->edge_lanes[at], query);
    for (; lanes; lanes &= lanes - 1) out_->push_back({from, ~n.child[std::countr_zero(lanes)]});
  }
}

}  // namespace tactus::sim::features
