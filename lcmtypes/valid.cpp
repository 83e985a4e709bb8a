#include "lcmtypes/valid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_request_t.hpp>
#include <tactus/clock_map_t.hpp>
#include <tactus/clock_probe_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/degraded_t.hpp>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/frame_shown_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/picture_chunk_t.hpp>
#include <tactus/playout_request_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/scene_manifest_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/sync_report_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>

#include "lcmtypes/bump.h"
#include "lcmtypes/generation.h"
#include "lcmtypes/measured_modes.h"
#include "lcmtypes/page_limits.h"
#include "lcmtypes/plausible.h"

namespace tactus {
namespace {

using tactus::sane;  // from plausible.h, in addition to the overloads here
using tactus::sane_not_negative;

constexpr std::size_t kMaxProfileBytes = 65536;  // as sync/degradation
// A minute: a later presentation cannot belong to the event.
constexpr long kMaxDelay_ns = 60'000'000'000;
constexpr double kMaxPush = 1e6;  // N or N m: no object of a room withstands more
// Limit of the real-time factor: at this rate 1.7 s of simulated time pass between two pictures.
constexpr double kMaxSimRate = 100;

bool finite_positive(double x) { return std::isfinite(x) && x > 0; }  // the masses of fixed bodies are huge
bool sane(const vec3_t& v) { return sane(v.x) && sane(v.y) && sane(v.z); }
bool sane(const vec3f_t& v) { return sane(v.x) && sane(v.y) && sane(v.z); }
bool sane_not_negative(const vec3_t& v) { return sane(v) && v.x >= 0 && v.y >= 0 && v.z >= 0; }
bool within(double value, double low, double high) { return value >= low && value <= high; }

template <class Q>
bool rotation(const Q& q) {
  const double norm = double(q.w) * q.w + double(q.x) * q.x + double(q.y) * q.y + double(q.z) * q.z;
  return std::isfinite(norm) && std::abs(norm - 1) < 1e-3;
}

template <class V>
bool unit(const V& v) {
  const double norm = double(v.x) * v.x + double(v.y) * v.y + double(v.z) * v.z;
  return std::isfinite(norm) && std::abs(norm - 1) < 1e-2;
}

bool sane(const pose_t& p) { return sane(p.position_m) && rotation(p.orientation); }
bool page_of(int page, int pages, int max_pages) { return between(pages, 1, max_pages) && page >= 0 && page < pages; }

bool sane(const sim_clock_t& c) {
  return between(c.sim_ns, 0, kMaxTime_ns) && between(c.host_ns, 0, kMaxTime_ns) && sane_not_negative(c.rate) &&
         c.rate <= kMaxSimRate;
}

bool sane(const contact_event_t& e) {
  return between(e.kind, contact_event_t::BEGIN, contact_event_t::END) && between(e.time_ns, 0, kMaxTime_ns) &&
         e.body_a >= 0 && e.body_b >= 0 && e.material_a >= -1 && e.material_b >= -1 && e.tool >= -1 &&
         sane(e.point_m) && unit(e.normal) && sane_not_negative(e.approach_speed_m_s) &&
         finite_positive(e.effective_mass_kg) && sane_not_negative(e.curvature_1_m);
}

bool sane(const contact_t& c) {
  if (!between(c.kind, contact_t::POINT, contact_t::SURFACE) || c.body_a < 0 || c.body_b < 0 ||
      c.material_a < -1 || c.material_b < -1 || c.tool < -1 || !unit(c.normal) || !sane(c.depth_m) ||
      !sane_not_negative(c.area_m2) || !sane_not_negative(c.normal_force_N) || !sane_not_negative(c.impulse_N_s) ||
      !sane(c.sliding_velocity_m_s) || !sane(c.rolling_velocity_m_s) || !between(c.point_count, 1, 4))
    return false;
  for (const contact_point_t& p : c.points)
    if (!sane(p.a_world_m) || !sane(p.b_world_m) || !sane(p.a_body_m) || !sane(p.b_body_m)) return false;
  return true;
}

bool sane(const body_state_t& b) {
  return b.body >= 0 && sane(b.position_m) && rotation(b.orientation) && sane(b.velocity_m_s) &&
         sane(b.angular_velocity_rad_s);
}

bool sane(const touch_plane_t& p) {
  return p.body >= 0 && p.material >= -1 && sane(p.point_m) && unit(p.normal) && sane(p.point_body_m) &&
         unit(p.normal_body) && sane(p.tool_point_m) && sane(p.velocity_m_s) && sane(p.angular_velocity_rad_s) &&
         finite_positive(p.effective_mass_kg) && sane_not_negative(p.stiffness_N_m) &&
         sane_not_negative(p.damping_N_s_m) && sane_not_negative(p.friction_static) &&
         sane_not_negative(p.friction_dynamic) && sane(p.bump_u);
}

bool sane(const touch_applied_t& a) { return sane(a.impulse_N_s) && sane(a.energy_J); }
bool sane(const tool_constraint_t& c) {
  return c.body >= 0 && sane(c.point_m) && sane(c.force_N) && sane(c.impulse_N_s) && clock_time(c.impulse_since_ns);
}
bool sane(const playout_entry_t& e) {
  return name(e.modality) && between(e.delay_ns, 0, kMaxDelay_ns) &&
         between(e.soa_ns, -kMaxDelay_ns, kMaxDelay_ns) && between(e.needs_ns, -1, kMaxDelay_ns);
}
bool sane(const map_def_t& d) {
  return !d.tag.empty() && d.tag.size() <= 128 && printable(d.tag) && !d.setting.empty() &&
         d.setting.size() <= 128 && printable(d.setting) && sane(d.gain) && sane(d.offset) && sane(d.low) &&
         sane(d.high) && d.low <= d.high;
}
bool sane(const hole_state_t& h) {
  return name(h.name) && h.ball >= 0 && h.inside >= -1 && between(h.filled, 0, 1);
}
bool sane(const decision_t& d) {
  return between(d.is_event, 0, 1) && d.time_ns >= 0 && between(d.drop_reason, 0, 6) && d.held_ns >= 0 &&
         between(d.twice, 0, 1);
}
bool sane(const presentation_t& p) {
  return between(p.part, presentation_t::WHOLE, presentation_t::TRANSIENT) && p.ready_ns >= -1 &&
         p.scheduled_ns >= -1 && p.presented_ns >= -1 && p.uncertainty_ns >= 0 &&
         between(p.outcome, presentation_t::PRESENTED, presentation_t::INAUDIBLE);
}
bool sane(const histogram_t& h) {
  return h.max_ns >= 0 && std::all_of(std::begin(h.bins), std::end(h.bins), [](int bin) { return bin >= 0; });
}
bool sane(const input_health_t& i) {
  return i.age_ns >= -1 && i.uncertainty_ns >= -1 && i.messages >= 0 && i.gaps >= 0 && i.bad >= 0;
}
bool sane(const pair_report_t& p) {
  return p.n >= 0 && p.uncertainty_ns >= 0 && p.beyond_least >= -1 && p.beyond_all >= -1;
}
bool sane(const asset_ref_t& a) { return a.size > 0 && between(a.kind, asset_ref_t::SCENE, asset_ref_t::SHADER); }
bool sane_bump(const material_def_t& m) {
  if (m.bump_asset == 0) return sane(m.bump_size_u_m) && sane(m.bump_size_v_m) && sane(m.bump_height_m);
  return within(m.bump_size_u_m, kMinBumpSize_m, kMaxBumpSize_m) &&
         within(m.bump_size_v_m, kMinBumpSize_m, kMaxBumpSize_m) &&
         within(m.bump_height_m, kMinBumpHeight_m, kMaxBumpHeight_m);
}
bool sane_friction_map(const material_def_t& m) {
  if (m.friction_asset == 0)
    return sane(m.friction_size_u_m) && sane(m.friction_size_v_m) && sane(m.friction_black) &&
           sane(m.friction_white);
  return within(m.friction_size_u_m, kMinBumpSize_m, kMaxBumpSize_m) &&
         within(m.friction_size_v_m, kMinBumpSize_m, kMaxBumpSize_m) &&
         within(m.friction_black, 0, kMaxFrictionFactor) && within(m.friction_white, 0, kMaxFrictionFactor);
}
bool sane(const measured_mode_t& m) {
  return m.frequency_Hz >= kMinModeFrequency_Hz && m.frequency_Hz <= kMaxModeFrequency_Hz && m.damping_1_s > 0 &&
         m.damping_1_s < 2 * std::numbers::pi * m.frequency_Hz && finite_positive(m.amplitude);
}
bool sane(const material_def_t& m) {
  // Young's modulus of diamond is 1.2e12 Pa, above the general limit of magnitudes.
  return finite_positive(m.youngs_modulus_Pa) && sane(m.poissons_ratio) && sane_not_negative(m.density_kg_m3) &&
         sane_not_negative(m.rayleigh_alpha_1_s) && sane_not_negative(m.rayleigh_beta_s) &&
         sane_not_negative(m.friction_static) && sane_not_negative(m.friction_dynamic) &&
         sane_not_negative(m.restitution) && sane_not_negative(m.conductivity_W_mK) &&
         sane_not_negative(m.specific_heat_J_kgK) && sane(m.temperature_degC) && sane_bump(m) &&
         sane_friction_map(m) && m.mode_count <= kMaxMeasuredModes &&
         std::all_of(m.modes.begin(), m.modes.end(), [](const measured_mode_t& mode) { return sane(mode); });
}
bool sane(const shape_def_t& s, int bodies, int materials) {
  return between(s.body, 0, bodies - 1) && between(s.material, -1, materials - 1) && sane(s.pose) &&
         between(s.kind, shape_def_t::BOX, shape_def_t::MESH) && sane_not_negative(s.size_m);
}
bool sane(const visual_def_t& v) {
  return sane(v.ambient) && sane(v.diffuse) && sane(v.specular) && sane(v.emissive) &&
         sane_not_negative(v.shininess) && sane_not_negative(v.alpha);
}
bool identifier(const std::string& text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !text.empty() && text.size() <= 64 && letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}
bool sane(const uniform_t& u) {
  return identifier(u.name) && between(u.count, 1, 4) &&
         std::all_of(u.values, u.values + 4, [](float x) { return sane(x); });
}
bool sane(const light_def_t& l) {
  return between(l.kind, light_def_t::POINT, light_def_t::SPOT) && sane(l.pose) && unit(l.direction) &&
         sane(l.diffuse) && sane(l.specular) && sane_not_negative(l.range_m) && sane(l.attenuation_constant) &&
         sane(l.attenuation_linear) && sane(l.attenuation_quadratic) && sane_not_negative(l.intensity) &&
         sane_not_negative(l.inner_angle_rad) && sane_not_negative(l.outer_angle_rad) &&
         sane_not_negative(l.falloff);
}
bool sane_uniforms(const std::vector<uniform_t>& list) {
  return std::all_of(list.begin(), list.end(), [](const uniform_t& u) { return sane(u); });
}
bool sane(const look_t& l) {
  return name(l.name) && (l.shader.empty() || name(l.shader)) && l.reflectance >= 0 && l.reflectance <= 1 &&
         sane_uniforms(l.uniforms);
}
bool sane(const pass_t& p) { return name(p.shader) && sane_uniforms(p.uniforms); }
bool sane(const shader_t& s) { return name(s.name) && s.fragment_asset != 0; }
bool sane(const waypoint_t& w) { return sane_not_negative(w.time_s) && sane(w.position_m); }

template <class List>
bool all_sane(const List& list) {
  for (const auto& item : list)
    if (!sane(item)) return false;
  return true;
}
// Common to a request and its answer.
bool sane_policy(const auto& m) {
  return between(m.generation, 0, kMaxGeneration) && between(m.policy, playout_t::ASAP, playout_t::ITOUCH2005) &&
         between(m.aligner, playout_t::FIXED, playout_t::QUANTILE) && between(m.base_ns, 0, kMaxDelay_ns) &&
         between(m.budget_ns, 0, kMaxDelay_ns) && all_sane(m.entries);
}

}  // namespace

bool valid(const contact_events_t& m) {
  return sane(m.header) && sane(m.clock) && page_of(m.page, m.pages, kMaxEventPages) && all_sane(m.events);
}
bool valid(const contact_frame_t& m) {
  return sane(m.header) && sane(m.clock) && between(m.group, contact_frame_t::TOOL, contact_frame_t::AHEAD) &&
         page_of(m.page, m.pages, kMaxContactPages) && all_sane(m.contacts);
}
bool valid(const world_state_t& m) {
  return sane(m.header) && sane(m.clock) && between(m.group, world_state_t::NOW, world_state_t::PROMOTED) &&
         sane_not_negative(m.rate_Hz) && page_of(m.page, m.pages, kMaxWorldPages) && all_sane(m.bodies);
}
bool valid(const touch_model_t& m) {
  return sane(m.header) && sane(m.clock) && m.tool >= 0 && page_of(m.page, m.pages, kMaxStatePages) && all_sane(m.planes) &&
         all_sane(m.applied);
}
bool valid(const tool_state_t& m) {
  return sane(m.header) && m.tool >= 0 && sane(m.device) && sane(m.proxy) && sane(m.device_velocity_m_s) &&
         sane(m.proxy_velocity_m_s) && sane(m.device_spin_rad_s) && sane(m.proxy_spin_rad_s) && sane(m.force_N) &&
         sane(m.torque_N_m) && sane(m.transient_N) && sane(m.energy_J) && sane(m.generated_J) && sane_not_negative(m.injected_J) &&
         m.coupling >= 0 && m.coupling <= 1 && m.fade >= 0 && m.fade <= 1 && all_sane(m.constraints);
}
bool valid(const device_state_t& m) {
  return sane(m.header) && name(m.device) && sane(m.pose) && sane(m.velocity_m_s) && sane(m.spin_rad_s) &&
         between(m.state, device_state_t::ANSWERS, device_state_t::LOST);
}
bool valid(const device_force_t& m) {
  return sane(m.header) && name(m.device) && sane(m.force_N) && sane(m.torque_N_m) &&
         between(m.valid_for_ns, 1, kMaxDelay_ns);
}
bool valid(const presented_t& m) { return sane(m.header) && name(m.modality) && all_sane(m.reports); }
bool valid(const node_health_t& m) {
  return sane(m.header) && name(m.node) && (m.modality.empty() || name(m.modality)) && between(m.expected_events, 0, 15) &&
         m.tool >= -1 && between(m.state, node_health_t::WAITING, node_health_t::READY) &&
         sane_not_negative(m.nominal_rate_Hz) && sane_not_negative(m.rate_Hz) && m.ticks >= 0 &&
         m.missed_ticks >= 0 && m.stale_ticks >= 0 && sane(m.tick) && sane(m.wake) && m.contacts_rendered >= 0 &&
         sane_not_negative(m.realtime_factor) && m.foreign_control >= 0 && m.quality >= 0 &&
         m.qualities >= m.quality && all_sane(m.inputs);
}
bool valid(const degradation_t& m) {
  return sane(m.header) && between(m.generation, 0, kMaxGeneration) && m.start_sim_ns >= 0 && between(m.size, 0, 65536) &&
         page_of(m.page, m.pages, kMaxProfilePages) && m.text.size() <= 1200;
}
bool valid(const degraded_t& m) { return sane(m.header) && name(m.modality) && all_sane(m.decisions); }
bool valid(const playout_t& m) {
  // A lock-step period is at most a minute.
  return sane(m.header) && sane_policy(m) && (m.lockstep_Hz == 0 || (m.lockstep_Hz >= 1.0 / 60 && m.lockstep_Hz <= 1e4));
}
bool valid(const playout_request_t& m) { return sane(m.header) && sane_policy(m); }
bool valid(const sim_command_t& m) {
  const auto within = [](const vec3_t& v) {
    return sane(v) && std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= kMaxPush;
  };
  return sane(m.header) && m.id > 0 && between(m.kind, sim_command_t::PAUSE, sim_command_t::RESTORE) &&
         between(m.steps, 0, 1'000'000) && (m.name.empty() || name(m.name)) && m.property.size() <= 32 &&
         (m.property.empty() || name(m.property)) && between(m.count, 0, 6) &&
         std::all_of(m.values.begin(), m.values.end(), [](double x) { return sane(x); }) && within(m.force_N) &&
         within(m.torque_N_m) && between(m.duration_ns, 0, kMaxDelay_ns) && between(m.to_file, 0, 1);
}
bool valid(const sim_reply_t& m) {
  return sane(m.header) && m.id > 0 && between(m.done, 0, 1) && m.text.size() <= 512 && between(m.paused, 0, 1);
}
bool valid(const game_state_t& m) {
  return sane(m.header) && sane(m.clock) && between(m.won, 0, 1) && between(m.won_ns, -1, kMaxTime_ns) &&
         between(m.count, 0, 16) && all_sane(m.holes);
}
bool valid(const log_info_t& m) {
  return sane(m.header) && sane_not_negative(m.seconds) && between(m.live_from_ns, 0, kMaxTime_ns);
}
bool valid(const media_clock_t& m) {
  return sane(m.header) && !m.medium.empty() && m.index >= 0 && m.host_time_ns >= 0 &&
         between(m.reason, media_clock_t::START, media_clock_t::UNDERFLOW);
}
bool valid(const frame_shown_t& m) {
  return sane(m.header) && m.frame >= 0 && clock_time(m.due_ns) && m.head_ns >= -1 &&
         between(m.stage, frame_shown_t::READY, frame_shown_t::SHOWN);
}
bool valid(const picture_chunk_t& m) {
  return sane(m.header) && m.picture >= 0 && m.presented_ns >= -1 && m.width > 0 && m.height > 0 && page_of(m.chunk, m.chunks, kMaxPictureChunks) &&
         between(m.size, 1, 1024);
}
bool valid(const thermal_device_t& m) {
  const auto temperature = [](double degC) { return degC >= -273.15 && degC <= 1000; };
  return sane(m.header) && m.tool >= 0 && temperature(m.plate_degC) && temperature(m.sink_degC) &&
         sane(m.current_A) && sane(m.voltage_V) && between(m.state, thermal_device_t::OK, thermal_device_t::FAULT);
}
bool valid(const thermal_state_t& m) {
  return sane(m.header) && m.tool >= 0 && m.material >= -1 && sane_not_negative(m.force_N) &&
         sane_not_negative(m.area_m2) && sane(m.heat_flux_W_m2) && sane(m.skin_degC) && sane(m.commanded_degC);
}
bool valid(const sync_report_t& m) { return sane(m.header) && page_of(m.page, m.pages, kMaxReportPages) && all_sane(m.pairs); }
bool valid(const clock_probe_t& m) {
  if (!sane(m.header) || !between(m.kind, clock_probe_t::REQUEST, clock_probe_t::REPLY) ||
      !clock_time(m.request_sent_ns))
    return false;
  if (m.kind == clock_probe_t::REQUEST)
    return m.asking_clock == m.header.clock && m.request_arrived_ns == -1 && m.reply_sent_ns == -1;
  return m.asking_clock != m.header.clock && clock_time(m.request_arrived_ns) && clock_time(m.reply_sent_ns) &&
         m.request_arrived_ns <= m.reply_sent_ns;
}
bool valid(const clock_map_t& m) {
  return sane(m.header) && m.of_clock != m.to_clock && m.to_clock == m.header.clock && clock_time(m.at_ns) &&
         between(m.offset_ns, -kLatestClockTime, kLatestClockTime) && std::abs(m.drift) <= 0.002 &&
         m.uncertainty_ns >= 0 && m.uncertainty_drift >= 0 && m.uncertainty_drift <= 0.01 && m.epoch >= 0 &&
         m.round_trip_ns >= 0 && m.replies >= 0;
}
bool valid(const scene_manifest_t& m) { return sane(m.header) && page_of(m.page, m.pages, kMaxManifestPages) && all_sane(m.assets); }
bool valid(const asset_request_t& m) {
  return sane(m.header) && m.first_chunk >= 0 && between(m.chunk_count, 1, 1 << 20);
}
bool valid(const asset_chunk_t& m) {
  return sane(m.header) && page_of(m.chunk, m.chunks, kMaxAssetChunks) && between(m.size, 1, 1024);
}

bool valid(const mesh_t& m) {
  const std::int64_t vertices = m.vertex_floats / 3;
  return m.vertex_floats % 3 == 0 && m.index_count % 3 == 0 && all_sane(m.positions_m) && all_sane(m.normals) &&
         (m.texcoord_floats == 0 || m.texcoord_floats == 2 * vertices) && all_sane(m.texcoords) &&
         (m.tangent_floats == 0 || m.tangent_floats == 4 * vertices) && all_sane(m.tangents) &&
         std::all_of(m.indices.begin(), m.indices.end(), [&](int i) { return between(i, 0, vertices - 1); });
}

bool valid(const scene_t& m) {
  for (int i = 0; i < m.body_count; ++i) {
    const body_def_t& b = m.bodies[i];
    if (b.id != i || !sane(b.pose) || !sane_not_negative(b.mass_kg) || !between(b.tool, -1, m.tool_count - 1))
      return false;
  }
  for (const shape_def_t& s : m.shapes)
    if (!sane(s, m.body_count, m.material_count)) return false;
  for (const visual_def_t& v : m.visuals)
    if (!sane(v.shape, m.body_count, m.material_count) || !sane(v) || !between(v.look, -1, m.look_count - 1))
      return false;
  for (const tool_def_t& t : m.tools)
    if (!between(t.body, 0, m.body_count - 1) || !between(t.shape, tool_def_t::BALL, tool_def_t::MESH) ||
        !sane_not_negative(t.radius_m) || !sane_not_negative(t.size_m) || !finite_positive(t.mass_kg) ||
        !between(t.material, -1, m.material_count - 1) || !all_sane(t.waypoints))
      return false;
  return m.step_ns > 0 && sane(m.gravity_m_s2) && all_sane(m.materials) && all_sane(m.lights) &&
         all_sane(m.looks) && all_sane(m.shaders) && all_sane(m.passes) && sane(m.camera) &&
         sane_not_negative(m.camera_fov_rad) && m.profile.size() <= kMaxProfileBytes && sane(m.ambient) &&
         sane(m.background) && sane(m.listener) && all_sane(m.maps);
}

}  // namespace tactus
