#include "sync/log/split_page.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_point_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>
#include <vector>

#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"
#include "sync/log/log_reader.h"
#include "sync/log/log_writer.h"
#include "sync/log/recorder_types.h"
#include "sync/log/upgrade_log.h"
#include "tests/lcmtypes/samples.h"
#include "tests/sync/support/memory_sink.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

using ByteList = std::vector<std::uint8_t>;

// Bytes of these types when positions had single precision.
std::size_t old_bytes(const contact_t& c) { return 82 + 48 * c.points.size(); }
constexpr std::size_t kOldEvent = 81, kOldPlane = 152, kOldApplied = 40;

// A page that filled a datagram with positions of single precision.
contact_frame_t full_contacts(test::Samples& samples) {
  contact_frame_t m{};
  samples.fill(m);
  m.contacts.clear();
  for (std::size_t bytes = static_cast<std::size_t>(contact_frame_t{}.getEncodedSize());;) {
    contact_t c{};
    samples.fill(c);
    bytes += old_bytes(c);
    if (bytes > channels::kMaxMessageBytes) break;
    m.contacts.push_back(c);
  }
  m.count = static_cast<std::int32_t>(m.contacts.size());
  return m;
}

template <class Element>
ByteList bytes_of(const std::vector<Element>& items) {
  ByteList all;
  for (const Element& item : items) {
    ByteList one(static_cast<std::size_t>(item._getEncodedSizeNoHash()));
    item._encodeNoHash(one.data(), 0, static_cast<int>(one.size()));
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}
template <class Element>
std::vector<Element> joined(std::vector<Element> a, const std::vector<Element>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

template <class Message>
std::array<Message, 2> halves_of(const Message& whole) {
  const auto halves = split_page(encode(whole));
  REQUIRE(halves);
  std::array<Message, 2> out;
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK((*halves)[i].size() <= channels::kMaxMessageBytes);
    const auto m = decode<Message>((*halves)[i].data(), (*halves)[i].size());
    REQUIRE(m);
    out[i] = *m;
    CHECK(out[i].page == 2 * whole.page + static_cast<int>(i));
    CHECK(out[i].pages == 2 * whole.pages);
    CHECK(out[i].header.seq == 2 * whole.header.seq + static_cast<std::int64_t>(i));
    CHECK(out[i].header.sim_time_ns == whole.header.sim_time_ns);
  }
  return out;
}

template <class Number>
void append_big_endian(ByteList& out, Number value) {
  ByteList raw(sizeof value);
  std::memcpy(raw.data(), &value, sizeof value);
  out.insert(out.end(), raw.rbegin(), raw.rend());
}
template <class Vector>
void append_single(ByteList& out, const Vector& v) {
  for (const auto x : {v.x, v.y, v.z}) append_big_endian(out, static_cast<float>(x));
}

constexpr std::int64_t kOldFrame = 0x0123456789abcde0;

// The message of a release in which positions had single precision.
ByteList in_old_form(const contact_frame_t& m) {
  contact_frame_t head = m;
  head.contacts.clear(), head.count = 0;
  ByteList out = encode(head);
  for (std::size_t i = 0; i < 8; ++i) out[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(kOldFrame) >> (56 - 8 * i));
  out.resize(out.size() - 4);
  append_big_endian(out, m.count);
  for (const contact_t& c : m.contacts) {
    append_big_endian(out, c.contact_id), append_big_endian(out, c.kind);
    for (const std::int32_t x : {c.body_a, c.body_b, c.material_a, c.material_b, c.tool}) append_big_endian(out, x);
    append_single(out, c.normal);
    for (const float x : {c.depth_m, c.area_m2, c.normal_force_N, c.impulse_N_s}) append_big_endian(out, x);
    append_single(out, c.sliding_velocity_m_s), append_single(out, c.rolling_velocity_m_s);
    append_big_endian(out, c.point_count);
    for (const contact_point_t& p : c.points)
      append_single(out, p.a_world_m), append_single(out, p.b_world_m), append_single(out, p.a_body_m), append_single(out, p.b_body_m);
  }
  return out;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size()) text.replace(at, from.size(), to);
}

std::vector<std::string> types_with_single_positions() {
  std::vector<std::string> pages = log_types();
  const auto number = [](std::int64_t x) {
    char text[20];
    std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(x));
    return std::string(text);
  };
  for (std::string& page : pages) {
    for (const char* name : {"a_world_m", "b_world_m", "a_body_m", "b_body_m"})
      replace_all(page, "  vec3_t " + std::string(name) + "\n", "  vec3f_t " + std::string(name) + "\n");
    replace_all(page, number(contact_frame_t::getHash()), number(kOldFrame));
    replace_all(page, number(contact_t::getHash()), number(kOldFrame + 1));
    replace_all(page, number(contact_point_t::getHash()), number(kOldFrame + 2));
  }
  return pages;
}

void round_positions(contact_frame_t& m) {
  for (contact_t& c : m.contacts)
    for (contact_point_t& p : c.points)
      for (vec3_t* v : {&p.a_world_m, &p.b_world_m, &p.a_body_m, &p.b_body_m})
        for (double* x : {&v->x, &v->y, &v->z}) *x = static_cast<double>(static_cast<float>(*x));
}

}  // namespace

TEST_CASE("Both halves of a page that filled a datagram in single precision fit one, and hold all of it in order") {
  test::Samples samples(3);
  for (int round = 0; round < 500; ++round) {
    const contact_frame_t m = full_contacts(samples);
    const auto half = halves_of(m);
    CHECK(bytes_of(joined(half[0].contacts, half[1].contacts)) == bytes_of(m.contacts));
    CHECK(half[1].group == m.group);
    contact_events_t e{};
    samples.fill(e);
    const std::size_t events = (channels::kMaxMessageBytes - static_cast<std::size_t>(contact_events_t{}.getEncodedSize())) / kOldEvent;
    e.events.assign(events, contact_event_t{});
    for (contact_event_t& x : e.events) samples.fill(x);
    e.count = static_cast<std::int32_t>(events);
    const auto half_events = halves_of(e);
    CHECK(bytes_of(joined(half_events[0].events, half_events[1].events)) == bytes_of(e.events));
  }
  touch_model_t t{};
  samples.fill(t);
  t.planes.assign(7, touch_plane_t{}), t.applied.assign(6, touch_applied_t{});
  CHECK(88 + 7 * kOldPlane + 6 * kOldApplied <= channels::kMaxMessageBytes);
  for (touch_plane_t& p : t.planes) samples.fill(p);
  for (touch_applied_t& a : t.applied) samples.fill(a);
  t.plane_count = 7, t.applied_count = 6;
  const auto half = halves_of(t);
  CHECK(bytes_of(joined(half[0].planes, half[1].planes)) == bytes_of(t.planes));
  CHECK(bytes_of(joined(half[0].applied, half[1].applied)) == bytes_of(t.applied));
}

TEST_CASE("Bytes that are not one whole page are not split") {
  test::Samples samples(5);
  const ByteList whole = encode(full_contacts(samples));
  for (std::size_t size = 0; size < whole.size(); size += 1 + size / 7) CHECK_FALSE(split_page(std::span(whole).first(size)));
  CHECK_FALSE(split_page(ByteList(100, 0)));
  touch_model_t many{};
  samples.fill(many);
  many.page = 60, many.pages = 100;
  CHECK_FALSE(split_page(encode(many)));
}

TEST_CASE("A log with full pages of positions in single precision is converted to pages that fit a datagram") {
  test::Samples samples(9);
  ByteList log;
  std::int64_t number = 0;
  for (const std::string& page : types_with_single_positions())
    append_event(log, number++, 10, kLogTypes, ByteList(page.begin(), page.end()));
  std::vector<contact_frame_t> sent;
  for (int i = 0; i < 60; ++i) {
    contact_frame_t m = full_contacts(samples);
    m.header.seq = i, m.page = i % 3, m.pages = 3;
    sent.push_back(m);
    append_event(log, number++, 20 + i, channels::kContacts, in_old_form(m));
  }
  const auto state = std::make_shared<MemorySink::State>();
  const UpgradeCounts counts = upgrade_log(log, std::make_unique<MemorySink>(state));
  CHECK(counts.converted == 60);
  std::vector<contact_frame_t> received;
  LogScanner scanner(state->bytes);
  for (LogEvent e; scanner.next(e);) {
    if (e.channel == kLogTypes) continue;
    const auto m = decode<contact_frame_t>(e.data.data(), e.data.size());
    REQUIRE(m);
    CHECK(m->header.seq == static_cast<std::int64_t>(received.size()));
    CHECK(m->pages == 6);
    CHECK(m->page == static_cast<int>(received.size()) % 6);
    received.push_back(*m);
  }
  REQUIRE(received.size() == 120);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    round_positions(sent[i]);
    CHECK(bytes_of(joined(received[2 * i].contacts, received[2 * i + 1].contacts)) == bytes_of(sent[i].contacts));
  }
}
