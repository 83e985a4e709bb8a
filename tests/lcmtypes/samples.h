// A random valid message of every type, to round-trip and to damage.
#pragma once

#include <cmath>
#include <random>
#include <string>

#include "lcmtypes/valid.h"
#include "tests/lcmtypes/all_messages.h"

namespace tactus::test {

class Samples {
 public:
  explicit Samples(unsigned seed) : random_(seed) {}

  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  float single(double low, double high) { return static_cast<float>(real(low, high)); }

  void fill(header_t& h) {
    h.sim_time_ns = whole(-1, 1'000'000'000);
    h.publish_time_ns = whole(0, 1'000'000'000);
    h.clock = whole(-1000, 1000);
    h.run_id = whole(1, 100);
    h.source = whole(-1000, 1000);
    h.incarnation = whole(1, 1000);
    h.seq = whole(0, 1000);
  }
  void fill(sim_clock_t& c) { c.sim_ns = whole(0, 1000), c.host_ns = whole(0, 1000), c.rate = real(0, 2); }
  void fill(vec3_t& v) { v.x = real(-9, 9), v.y = real(-9, 9), v.z = real(-9, 9); }
  void fill(vec3f_t& v) { v.x = single(-9, 9), v.y = single(-9, 9), v.z = single(-9, 9); }
  template <class Vector>
  void fill_unit(Vector& v) {
    double norm = 0;
    while (norm < 0.1) {
      fill(v);
      norm = std::sqrt(double(v.x) * v.x + double(v.y) * v.y + double(v.z) * v.z);
    }
    using Number = decltype(v.x);
    v.x = Number(v.x / norm), v.y = Number(v.y / norm), v.z = Number(v.z / norm);
  }
  template <class Quaternion>
  void fill_rotation(Quaternion& q) {
    vec3_t axis{};
    fill_unit(axis);
    const double half = real(-3, 3), s = std::sin(half);
    using Number = decltype(q.w);
    q.w = Number(std::cos(half)), q.x = Number(s * axis.x), q.y = Number(s * axis.y), q.z = Number(s * axis.z);
  }
  void fill(pose_t& p) { fill(p.position_m), fill_rotation(p.orientation); }
  std::string name(int longest = 12) {
    std::string text(static_cast<std::size_t>(whole(1, longest)), 'a');
    for (char& c : text) c = static_cast<char>(whole('a', 'z'));
    return text;
  }
  template <class Count, class Item>
  void fill_list(Count& count, std::vector<Item>& list, int low, int high) {
    list.assign(static_cast<std::size_t>(whole(low, high)), Item{});
    for (Item& item : list) fill(item);
    count = static_cast<Count>(list.size());
  }
  template <class Message>
  void fill_page(Message& m) {
    m.pages = whole(1, 9);
    m.page = whole(0, m.pages - 1);
  }

  void fill(contact_event_t& e) {
    e.event_id = whole(0, 1 << 30), e.contact_id = whole(0, 1 << 30);
    e.kind = static_cast<std::int8_t>(whole(0, 2));
    e.time_ns = whole(0, 1 << 30);
    e.body_a = whole(0, 9), e.body_b = whole(10, 20), e.material_a = whole(-1, 9), e.material_b = whole(-1, 9);
    e.tool = whole(-1, 2);
    fill(e.point_m), fill_unit(e.normal);
    e.approach_speed_m_s = single(0, 9), e.effective_mass_kg = single(0.001, 9), e.curvature_1_m = single(0, 1000);
  }
  void fill(contact_point_t& p) { fill(p.a_world_m), fill(p.b_world_m), fill(p.a_body_m), fill(p.b_body_m); }
  void fill(contact_t& c) {
    c.contact_id = whole(0, 1 << 30);
    c.kind = static_cast<std::int8_t>(whole(0, 2));
    c.body_a = whole(0, 9), c.body_b = whole(10, 20), c.material_a = whole(-1, 9), c.material_b = whole(-1, 9);
    c.tool = whole(-1, 2);
    fill_unit(c.normal);
    c.depth_m = single(-1, 1), c.area_m2 = single(0, 1), c.normal_force_N = single(0, 9),
    c.impulse_N_s = single(0, 9);
    fill(c.sliding_velocity_m_s), fill(c.rolling_velocity_m_s);
    fill_list(c.point_count, c.points, 1, 4);
  }
  void fill(body_state_t& b) {
    b.body = whole(0, 3000);
    fill(b.position_m), fill_rotation(b.orientation), fill(b.velocity_m_s), fill(b.angular_velocity_rad_s);
  }
  void fill(touch_plane_t& p) {
    p.contact_id = whole(0, 1 << 30), p.body = whole(0, 9), p.material = whole(-1, 9);
    fill(p.point_m), fill_unit(p.normal), fill(p.point_body_m), fill_unit(p.normal_body);
    fill(p.tool_point_m), fill(p.velocity_m_s), fill(p.angular_velocity_rad_s);
    p.effective_mass_kg = single(0.001, 9), p.stiffness_N_m = single(0, 9000), p.damping_N_s_m = single(0, 9);
    p.friction_static = single(0, 1), p.friction_dynamic = single(0, 1);
    p.bump_asset = whole(0, 100), fill(p.bump_u);
  }
  void fill(touch_applied_t& a) { a.contact_id = whole(0, 9), fill(a.impulse_N_s), a.energy_J = real(-1, 1); }
  void fill(tool_constraint_t& c) {
    c.contact_id = whole(0, 9), c.body = whole(0, 9), fill(c.point_m), fill(c.force_N), fill(c.impulse_N_s);
    c.impulse_since_ns = whole(0, 1 << 30);
  }
  void fill(presentation_t& p) {
    p.event_id = whole(0, 1 << 30), p.part = static_cast<std::int8_t>(whole(0, 2));
    p.ready_ns = whole(-1, 1 << 30), p.scheduled_ns = whole(-1, 1 << 30), p.presented_ns = whole(-1, 1 << 30), p.uncertainty_ns = whole(0, 1 << 30);
    p.outcome = static_cast<std::int8_t>(whole(0, 4));
  }
  void fill(int& bin) { bin = whole(0, 1 << 30); }
  void fill(histogram_t& h) { h.max_ns = whole(0, 1 << 30), fill_list(h.bin_count, h.bins, 0, 80); }
  void fill(input_health_t& i) {
    i.channel = name(), i.age_ns = whole(-1, 1000), i.uncertainty_ns = whole(-1, 9), i.messages = whole(0, 9), i.gaps = whole(0, 9),
    i.bad = whole(0, 9);
  }
  void fill(modality_report_t& r) { r.modality = name(), r.expected = whole(0, 9), r.presented = whole(0, 9); }
  void fill(pair_report_t& r) {
    r.a = name(), r.b = name(), r.n = whole(0, 9), r.p50_ns = whole(-1000, 1000);
    r.beyond_least = whole(-1, 9), r.beyond_all = whole(-1, 9);
  }
  void fill(asset_ref_t& a) {
    a.hash = whole(-9, 9), a.size = whole(1, 9999), a.kind = static_cast<std::int8_t>(whole(0, 3)),
    a.name = name();
  }

  void fill(contact_events_t& m) {
    fill(m.header), fill(m.clock), fill_page(m), fill_list(m.count, m.events, 0, 8);
  }
  void fill(contact_frame_t& m) {
    fill(m.header), fill(m.clock), fill_page(m);
    m.group = static_cast<std::int8_t>(whole(0, 2));
    fill_list(m.count, m.contacts, 0, 3);
  }
  void fill(world_state_t& m) {
    fill(m.header), fill(m.clock), fill_page(m);
    m.group = static_cast<std::int8_t>(whole(0, 2));
    m.full = static_cast<std::int8_t>(whole(0, 1)), m.rate_Hz = single(0, 60);
    fill_list(m.count, m.bodies, 0, 9);
  }
  void fill(touch_model_t& m) {
    fill(m.header), fill(m.clock);
    m.tool = whole(0, 3);
    m.pages = static_cast<std::int8_t>(whole(1, 9)), m.page = static_cast<std::int8_t>(whole(0, m.pages - 1));
    fill_list(m.plane_count, m.planes, 0, 6), fill_list(m.applied_count, m.applied, 0, 6);
  }
  void fill(tool_state_t& m) {
    fill(m.header);
    m.tool = whole(0, 3);
    fill(m.device), fill(m.proxy), fill(m.device_velocity_m_s), fill(m.proxy_velocity_m_s);
    fill(m.device_spin_rad_s), fill(m.proxy_spin_rad_s), fill(m.force_N), fill(m.torque_N_m), fill(m.transient_N);
    m.energy_J = single(-9, 9), m.generated_J = single(-9, 9), m.injected_J = single(0, 9), m.coupling = single(0, 1), m.touch_status = static_cast<std::int8_t>(whole(0, 5)), m.fade = single(0, 1);
    m.buttons = whole(0, 9);
    fill_list(m.constraint_count, m.constraints, 0, 8);
  }
  void fill(device_state_t& m) {
    fill(m.header);
    m.device = name(), fill(m.pose), fill(m.velocity_m_s), fill(m.spin_rad_s);
    m.buttons = whole(0, 9), m.state = static_cast<std::int8_t>(whole(0, 1));
  }
  void fill(device_force_t& m) {
    fill(m.header);
    m.device = name(), fill(m.force_N), fill(m.torque_N_m), m.valid_for_ns = whole(1, 1'000'000'000);
  }
  void fill(thermal_state_t& m) {
    fill(m.header);
    m.tool = whole(0, 3), m.material = whole(-1, 9), m.force_N = single(0, 9), m.area_m2 = single(0, 1);
    m.heat_flux_W_m2 = single(-9000, 9000), m.skin_degC = single(0, 50), m.commanded_degC = single(15, 42);
    m.limited = static_cast<std::int8_t>(whole(0, 1));
  }
  void fill(thermal_device_t& m) {
    fill(m.header);
    m.tool = whole(0, 3), m.plate_degC = single(10, 43), m.sink_degC = single(-10, 60);
    m.current_A = single(-6, 6), m.voltage_V = single(-4, 4), m.state = static_cast<std::int8_t>(whole(0, 2));
  }
  void fill(presented_t& m) { fill(m.header), m.modality = name(), fill_list(m.count, m.reports, 0, 30); }
  void fill(node_health_t& m) {
    fill(m.header);
    m.node = name(), m.modality = whole(0, 1) ? name() : "", m.status_text = name(80);
    m.expected_events = whole(0, 7), m.tool = whole(-1, 3), m.state = static_cast<std::int8_t>(whole(0, 4));
    m.nominal_rate_Hz = real(0, 1000), m.rate_Hz = real(0, 1000), m.ticks = whole(0, 99),
    m.missed_ticks = whole(0, 99);
    m.qualities = static_cast<std::int8_t>(whole(1, 4)), m.quality = static_cast<std::int8_t>(whole(0, 1));
    m.stale_ticks = whole(0, 99), m.profile = whole(0, 99);
    fill(m.tick), fill(m.wake);
    m.contacts_rendered = whole(0, 99), m.realtime_factor = real(0, 1), m.kernel_drops = whole(-1, 9);
    fill_list(m.input_count, m.inputs, 0, 6);
  }
  void fill(sync_report_t& m) {
    fill(m.header), fill_page(m);
    m.begins = whole(0, 99), m.hits = whole(0, 99), m.ends = whole(0, 99);
    fill_list(m.modality_count, m.modalities, 0, 5), fill_list(m.pair_count, m.pairs, 0, 6);
  }
  void fill(clock_probe_t& m) {
    fill(m.header);
    m.kind = static_cast<std::int8_t>(whole(0, 1)), m.nonce = whole(-1000, 1000), m.request_sent_ns = whole(0, 1000);
    const bool reply = m.kind == clock_probe_t::REPLY;
    m.asking_clock = reply ? m.header.clock + 1 : m.header.clock;
    m.request_arrived_ns = reply ? whole(0, 1000) : -1;
    m.reply_sent_ns = reply ? m.request_arrived_ns + whole(0, 1000) : -1;
  }
  void fill(clock_map_t& m) {
    fill(m.header);
    m.to_clock = m.header.clock, m.of_clock = m.to_clock - 1, m.at_ns = whole(0, 1000), m.offset_ns = whole(-1000, 1000);
    m.drift = real(-0.001, 0.001), m.uncertainty_ns = whole(0, 1000), m.uncertainty_drift = real(0, 0.001);
    m.epoch = whole(0, 5), m.round_trip_ns = whole(0, 1000), m.replies = whole(0, 8);
  }
  void fill(media_clock_t& m) {
    fill(m.header);
    m.medium = name(), m.index = whole(0, 99), m.host_time_ns = whole(0, 99),
    m.reason = static_cast<std::int8_t>(whole(0, 2));
  }
  void fill(frame_shown_t& m) {
    fill(m.header), m.frame = whole(0, 99), m.due_ns = whole(0, 99), m.head_ns = whole(-1, 99);
    m.stage = static_cast<std::int8_t>(whole(0, 1));
  }
  void fill(picture_chunk_t& m) {
    fill(m.header), m.picture = whole(0, 99), m.presented_ns = whole(-1, 99), m.width = m.height = 8, m.chunks = whole(1, 9), m.chunk = whole(0, m.chunks - 1);
    m.size = whole(1, 1024);
    m.data.assign(static_cast<std::size_t>(m.size), 7);
  }
  void fill(degradation_t& m) {
    fill(m.header), fill_page(m);
    m.generation = whole(0, 99), m.start_sim_ns = whole(0, 99), m.hash = whole(0, 99), m.size = whole(0, 999);
    m.text = name(1000);
  }
  void fill(decision_t& d) {
    d.key = whole(0, 99), d.is_event = static_cast<std::int8_t>(whole(0, 1)), d.time_ns = whole(0, 99);
    d.drop_reason = static_cast<std::int8_t>(whole(0, 5)), d.held_ns = whole(0, 99), d.twice = static_cast<std::int8_t>(whole(0, 1));
  }
  void fill(degraded_t& m) {
    fill(m.header), m.modality = name(), m.profile = whole(0, 99), fill_list(m.count, m.decisions, 0, 30);
  }
  void fill(playout_entry_t& e) {
    e.modality = name(), e.delay_ns = whole(0, 99), e.soa_ns = whole(-99, 99), e.needs_ns = whole(-1, 99);
  }
  void fill_policy(auto& m) {
    fill(m.header), m.generation = whole(0, 99), m.policy = static_cast<std::int8_t>(whole(0, 4));
    m.aligner = static_cast<std::int8_t>(whole(0, 1)), m.base_ns = whole(0, 99), m.budget_ns = whole(0, 99);
    fill_list(m.count, m.entries, 0, 6);
  }
  void fill(playout_t& m) { fill_policy(m), m.lockstep_Hz = real(0, 60); }
  void fill(playout_request_t& m) { fill_policy(m); }
  void fill(double& value) { value = real(-9, 9); }
  void fill(setting_change_t& m) {
    fill(m.header), m.id = whole(1, 1 << 30), m.node = name(), m.name = name(), m.value = name(200);
  }
  void fill(setting_reply_t& m) {
    fill(m.header), m.id = whole(1, 1 << 30), m.done = static_cast<std::int8_t>(whole(0, 1)), m.text = name(200);
  }
  void fill(question_t& m) {
    fill(m.header), m.id = whole(1, 1 << 30), m.kind = static_cast<std::int8_t>(whole(1, 3)), m.text = name(600);
    m.count = m.kind == question_t::CHOICE ? static_cast<std::int32_t>(whole(2, 9)) : 0;
    for (int i = 0; i < m.count; ++i) m.choices.push_back(name(40));
    if (m.kind == question_t::NUMBER) m.lowest = real(-9, 0), m.highest = real(1, 9), m.step = real(0.01, 1);
    m.trial = static_cast<std::int32_t>(whole(0, 999)), m.condition = name(), m.progress = name();
    m.hint = name(64), m.pages = 1;
  }
  void fill(answer_t& m) {
    fill(m.header), m.id = whole(1, 1 << 30), m.choice = static_cast<std::int32_t>(whole(-1, 8)), m.number = real(-9, 9);
    m.after_ns = whole(0, 99), m.by = name();
  }
  void fill(tag_def_t& t) { t.name = name(), t.unit = "N", t.rate_Hz = real(0, 99); }
  void fill(tag_list_t& m) {
    fill(m.header), m.node = name(), m.list = whole(1, 1 << 30), m.first = static_cast<std::int16_t>(whole(0, 9));
    m.tag_count = static_cast<std::int32_t>(whole(0, 9)), m.total = static_cast<std::int16_t>(m.first + m.tag_count + whole(0, 9));
    for (int i = 0; i < m.tag_count; ++i) fill(m.tags.emplace_back());
  }
  void fill(tag_request_t& m) {
    fill(m.header), m.pattern_count = static_cast<std::int32_t>(whole(0, 9));
    for (int i = 0; i < m.pattern_count; ++i) m.patterns.push_back(name());
  }
  void fill(tag_values_t& m) {
    fill(m.header), m.node = name(), m.list = whole(1, 1 << 30);
    m.column_count = static_cast<std::int32_t>(whole(1, 6)), m.row_count = static_cast<std::int32_t>(whole(1, 6));
    m.value_count = static_cast<std::int32_t>(m.column_count * m.row_count);
    for (std::int16_t i = 0; i < m.column_count; ++i) m.columns.push_back(i);
    for (int i = 0; i < m.row_count; ++i) m.times_ns.push_back(100 * i + whole(0, 99));
    for (int i = 0; i < m.value_count; ++i) fill(m.values.emplace_back());
  }
  void fill(sim_command_t& m) {
    fill(m.header), m.id = whole(1, 1 << 30), m.kind = static_cast<std::int8_t>(whole(0, 7)), m.steps = whole(0, 9);
    m.name = name(), m.property = name(), fill_list(m.count, m.values, 0, 6);
    fill(m.force_N), fill(m.torque_N_m), m.duration_ns = whole(0, 1 << 30), m.to_file = static_cast<std::int8_t>(whole(0, 1));
  }
  void fill(sim_reply_t& m) {
    fill(m.header), m.id = whole(1, 1 << 30), m.done = static_cast<std::int8_t>(whole(0, 1)), m.text = name(200);
    m.paused = static_cast<std::int8_t>(whole(0, 1));
  }
  void fill(hole_state_t& h) {
    h.name = name(), h.ball = whole(0, 9), h.inside = whole(-1, 9), h.filled = static_cast<std::int8_t>(whole(0, 1));
  }
  void fill(game_state_t& m) {
    fill(m.header), fill(m.clock), m.won = static_cast<std::int8_t>(whole(0, 1)), m.won_ns = whole(-1, 999);
    fill_list(m.count, m.holes, 0, 6);
  }
  void fill(log_info_t& m) {
    fill(m.header), m.header.sim_time_ns = -1;
    m.version = name(), m.git = name(), m.scene = name(), m.seed = whole(0, 99), m.seconds = real(0, 99);
    m.realtime_offset_ns = whole(0, 1 << 30), m.live_from_ns = whole(0, 1 << 30);
  }
  void fill(scene_manifest_t& m) { fill(m.header), fill_page(m), fill_list(m.count, m.assets, 0, 12); }
  void fill(asset_request_t& m) {
    fill(m.header), m.hash = whole(0, 99), m.first_chunk = whole(0, 99), m.chunk_count = whole(1, 99);
  }
  void fill(asset_chunk_t& m) {
    fill(m.header), m.hash = whole(0, 99), m.chunks = whole(1, 9), m.chunk = whole(0, m.chunks - 1);
    m.size = whole(1, 1024);
    m.data.assign(static_cast<std::size_t>(m.size), 7);
  }

  void fill(float& x) { x = single(-1, 1); }
  void fill(mesh_t& m) {
    const int vertices = whole(1, 40);
    m.vertex_floats = 3 * vertices;
    m.positions_m.resize(static_cast<std::size_t>(m.vertex_floats)), m.normals.resize(m.positions_m.size());
    for (float& x : m.positions_m) fill(x);
    for (float& x : m.normals) fill(x);
    if (whole(0, 1)) m.texcoord_floats = 2 * vertices, m.texcoords.assign(static_cast<std::size_t>(2 * vertices), single(0, 1));
    if (whole(0, 1)) m.tangent_floats = 4 * vertices, m.tangents.assign(static_cast<std::size_t>(4 * vertices), single(0, 1));
    m.index_count = 3 * whole(0, 20);
    for (int i = 0; i < m.index_count; ++i) m.indices.push_back(whole(0, vertices - 1));
  }
  void fill(material_def_t& m) {
    m.name = name(), m.youngs_modulus_Pa = 2e11, m.poissons_ratio = 0.3, m.density_kg_m3 = real(1, 9000);
    m.friction_static = real(0, 1), m.friction_dynamic = real(0, 1), m.restitution = real(0, 1);
    m.conductivity_W_mK = real(0, 400), m.specific_heat_J_kgK = real(100, 4000),
    m.temperature_degC = real(-20, 90);
    m.bump_asset = whole(0, 1);
    m.bump_size_u_m = real(0.001, 1), m.bump_size_v_m = real(0.001, 1), m.bump_height_m = real(1e-6, 0.01);
    m.friction_asset = whole(0, 1), m.friction_size_u_m = real(0.001, 1), m.friction_size_v_m = real(0.001, 1),
    m.friction_black = real(0, 2), m.friction_white = real(0, 2);
    m.mode_count = whole(0, 5);
    for (int i = 0; i < m.mode_count; ++i) m.modes.push_back({real(50, 9000), real(0.1, 90), real(0.01, 1)});
  }
  void fill(shape_def_t& s) {
    s.name = name(), s.body = 0, fill(s.pose), s.kind = static_cast<std::int8_t>(whole(0, 5));
    s.size_m.x = real(0, 1), s.size_m.y = real(0, 1), s.size_m.z = real(0, 1), s.mesh_hash = whole(0, 9),
    s.material = -1;
  }
  void fill(visual_def_t& v) {
    fill(v.shape), fill(v.ambient), fill(v.diffuse), fill(v.specular), fill(v.emissive);
    v.shininess = single(1, 90), v.alpha = single(0, 1), v.look = -1;
  }
  void fill(uniform_t& u) {
    u.name = name(), u.count = static_cast<std::int8_t>(whole(1, 4));
    for (float& x : u.values) fill(x);
  }
  void fill(look_t& l) {
    l.name = name(), l.shader = name(), l.colour_map = whole(0, 9), l.normal_map = whole(0, 9), l.reflectance = single(0, 1);
    fill_list(l.uniform_count, l.uniforms, 0, 3);
  }
  void fill(pass_t& p) { p.shader = name(), fill_list(p.uniform_count, p.uniforms, 0, 3); }
  void fill(shader_t& s) {
    s.name = name(), s.fragment_asset = whole(1, 9), s.vertex_asset = whole(0, 9), s.fragment_file = name();
  }
  void fill(light_def_t& l) {
    l.name = name(), l.kind = static_cast<std::int8_t>(whole(0, 2)), fill(l.pose), fill_unit(l.direction);
    fill(l.diffuse), fill(l.specular), l.range_m = single(0, 9), l.attenuation_constant = 1, l.intensity = 1;
  }
  void fill(waypoint_t& w) { w.time_s = real(0, 9), fill(w.position_m); }
  void fill(tool_def_t& t) {
    t.name = name(), t.radius_m = real(0, 1), t.shape = static_cast<std::int8_t>(whole(0, 3)), fill(t.size_m),
    t.size_m.x = std::abs(t.size_m.x), t.size_m.y = std::abs(t.size_m.y), t.size_m.z = std::abs(t.size_m.z), t.mass_kg = real(0.01, 1), t.material = -1, t.device = name();
    fill_list(t.waypoint_count, t.waypoints, 0, 5);
  }
  void fill(setting_t& s) { s.node = name(), s.name = name(), s.value = name(); }
  void fill(body_def_t& b) { b.name = name(), b.tool = -1, b.mass_kg = real(0, 9), fill(b.pose); }
  void fill(map_def_t& d) {
    d.tag = "x" + name(), d.setting = "y" + name(), d.gain = real(-9, 9), d.offset = real(-9, 9), d.low = real(-9, 0), d.high = real(0, 9);
  }
  void fill(scene_t& m) {
    m.name = name(), fill(m.gravity_m_s2), m.step_ns = 1'000'000;
    fill_list(m.body_count, m.bodies, 1, 5);
    for (int i = 0; i < m.body_count; ++i) m.bodies[static_cast<std::size_t>(i)].id = i;
    fill_list(m.shape_count, m.shapes, 0, 4), fill_list(m.visual_count, m.visuals, 0, 4);
    fill_list(m.look_count, m.looks, 0, 3), fill_list(m.shader_count, m.shaders, 0, 2);
    fill_list(m.pass_count, m.passes, 0, 2), m.environment_asset = whole(0, 9);
    fill_list(m.material_count, m.materials, 0, 3), fill_list(m.light_count, m.lights, 0, 3);
    fill_list(m.tool_count, m.tools, 0, 2), fill_list(m.setting_count, m.settings, 0, 3);
    fill_list(m.map_count, m.maps, 0, 3);
    fill(m.camera), m.camera_fov_rad = 1, m.profile = name(), fill(m.ambient), fill(m.background), fill(m.listener);
  }

 private:
  std::mt19937 random_;
};

}  // namespace tactus::test
