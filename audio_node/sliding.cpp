#include "audio_node/sliding.h"

#include <algorithm>
#include <cmath>

#include "lcmtypes/vectors.h"

namespace tactus::audio {
namespace {

constexpr double kLeastSpeed_m_s = 1e-3;  // below, nothing scrapes (design)
// Beyond these nothing becomes louder or faster: no hand does so, and nothing on the bus shall.
constexpr double kMostSpeed_m_s = 5, kMostForce_N = 50;

}  // namespace

Pictures pictures_of(const sync::SceneReceiver& scenes) {
  Pictures pictures;
  if (!scenes.scene()) return pictures;
  for (const material_def_t& m : scenes.scene()->materials)
    for (const std::int64_t hash : {m.bump_asset, m.friction_asset})
      if (const sync::Asset* asset = hash != 0 && !pictures.contains(hash) ? scenes.asset(hash) : nullptr)
        pictures.emplace(hash, asset->bytes);
  return pictures;
}

std::unique_ptr<HeightMaps> read_maps(const Pictures& pictures) {
  auto maps = std::make_unique<HeightMaps>();
  for (const auto& [hash, bytes] : pictures) try {
      maps->emplace(hash, read_height_map(bytes));
    } catch (const std::runtime_error&) {  // vision and touch say which and why
    }
  return maps;
}

const Relief* HeardReliefs::get(const material_def_t& m, const HeightMap& map) {
  auto& relief = reliefs_[{m.bump_asset, m.bump_size_u_m, m.bump_size_v_m, m.bump_height_m}];
  if (!relief) relief = std::make_unique<const Relief>(make_relief(map, m));
  return relief.get();
}

Sliding::Sliding(const scene_t& scene, const HeightMaps& maps, HeardReliefs& reliefs, const Settings& settings)
    : settings_(settings), listener_(to_eigen(scene.listener)) {
  for (const material_def_t& m : scene.materials) {
    Material& to = materials_.emplace_back();
    to.mu = m.friction_dynamic;
    if (const auto map = maps.find(m.bump_asset); map != maps.end()) to.relief = reliefs.get(m, map->second);
    if (const auto map = maps.find(m.friction_asset); map != maps.end())
      to.friction = std::make_shared<const FrictionMap>(map->second, m);
    any_ = any_ || to.heard();
  }
  for (const body_def_t& b : scene.bodies)
    if (b.is_static) standing_[b.id] = to_eigen(b.pose.orientation);
}

const Sliding::Material* Sliding::heard(std::int32_t body, std::int32_t material) const {
  const auto i = static_cast<std::size_t>(material);
  if (material < 0 || i >= materials_.size() || !materials_[i].heard() || !standing_.contains(body))
    return nullptr;
  return &materials_[i];
}

const std::vector<Scrape>& Sliding::scrapes(const sync::Contacts& contacts, sync::HostTime at, double dt_s) {
  out_.clear();
  for (auto& [id, way] : ways_) way.seen = false;
  for (const contact_t& c : contacts) {
    const Material* of_a = heard(c.body_a, c.material_a);
    const Material* m = of_a ? of_a : heard(c.body_b, c.material_b);
    const Eigen::Vector3d past = to_eigen(c.sliding_velocity_m_s);  // of b past a
    const double speed = std::min(past.norm(), kMostSpeed_m_s);
    if (!m || c.points.empty() || speed < kLeastSpeed_m_s) continue;
    const std::int32_t other = of_a ? c.material_b : c.material_a;
    // How the contact moves over the surface that wears the map, in its body.
    const Eigen::Quaterniond to_body = standing_.at(of_a ? c.body_a : c.body_b).conjugate();
    const Eigen::Vector3d way = to_body * (of_a ? past : Eigen::Vector3d(-past)).normalized();
    const Eigen::Vector3d outward = to_body * (of_a ? to_eigen(c.normal) : Eigen::Vector3d(-to_eigen(c.normal)));
    const Eigen::Vector3d place = to_eigen(of_a ? c.points[0].a_body_m : c.points[0].b_body_m);
    const Eigen::Vector3d place_world = to_eigen(of_a ? c.points[0].a_world_m : c.points[0].b_world_m);

    Way& gone = ways_[c.contact_id];
    gone.seen = true;
    gone.travelled_m += speed * std::clamp(dt_s, 0.0, 0.1);
    Scrape s;
    s.id = c.contact_id;
    s.at = at;
    s.travelled_m = gone.travelled_m;
    s.speed_m_s = speed;
    double mu = std::sqrt(m->mu * (other >= 0 && static_cast<std::size_t>(other) < materials_.size()
                                       ? materials_[static_cast<std::size_t>(other)].mu
                                       : 1.0));
    if (m->friction) mu *= pair_factor(m->friction->factor(outward, place));
    if (m->relief) {
      const BumpAxes axes = bump_axes(outward);
      const double size_u = static_cast<double>(m->relief->size_m.x()),
                   size_v = static_cast<double>(m->relief->size_m.y());
      s.relief = m->relief;
      s.u = place[axes.u] / size_u, s.v = place[axes.v] / size_v;
      s.along_u = way[axes.u], s.along_v = way[axes.v];
      s.u_per_s = speed * way[axes.u] / size_u, s.v_per_s = speed * way[axes.v] / size_v;
    }
    const double force_N = std::clamp<double>(static_cast<double>(c.normal_force_N), 0, kMostForce_N);
    s.level = static_cast<float>(settings_.gain * settings_.scrape_level * std::sqrt(mu * force_N * speed));
    const StereoGain gain = stereo_gain(listener_, place_world, settings_.nearest_m);
    s.left = static_cast<float>(gain.left), s.right = static_cast<float>(gain.right);
    out_.push_back(s);
  }
  std::erase_if(ways_, [](const auto& way) { return !way.second.seen; });
  return out_;
}

}  // namespace tactus::audio
