// The degradable content of each kind of snapshot on the bus: its key, its signals, its values, and its form without any
// contact. Pure.
#pragma once

#include <cstdint>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "sync/degradation/operator_chain.h"
#include "sync/random/keyed_random.h"

namespace tactus::sync {

// A key that all pages of one snapshot share and no other snapshot has. While the world stands still, repeated snapshots of
// bodies and contacts are identical and have the same key.
std::uint64_t snapshot_key(const contact_frame_t&);
std::uint64_t snapshot_key(const world_state_t&);
std::uint64_t snapshot_key(const touch_model_t&);
std::uint64_t snapshot_key(const tool_state_t&);

// The stream that a snapshot belongs to: groups or tools that alternate on one channel are separate streams.
std::uint64_t stream_of(const contact_frame_t&);
std::uint64_t stream_of(const world_state_t&);
std::uint64_t stream_of(const touch_model_t&);
std::uint64_t stream_of(const tool_state_t&);

// A key of one message, also among repetitions and pages of the same content.
template <class Message>
std::uint64_t wire_key(const Message& m) {
  return mixed(mixed(static_cast<std::uint64_t>(m.header.incarnation), static_cast<std::uint64_t>(m.header.seq)),
               static_cast<std::uint64_t>(m.header.source));
}

// Forces, velocities and positions by contact, body or plane, of one page; of a touch model impulses (touch_forces.h) in
// place of forces.
std::vector<Signal> signals_of(const contact_frame_t&);
std::vector<Signal> signals_of(const world_state_t&);
std::vector<Signal> signals_of(const touch_model_t&);
std::vector<Signal> signals_of(const tool_state_t&);

// False for a stream that carries no forces, so that a deadband on force cannot compare its snapshots.
constexpr bool has_forces(const contact_frame_t&) { return true; }
constexpr bool has_forces(const world_state_t&) { return false; }
constexpr bool has_forces(const touch_model_t&) { return true; }
constexpr bool has_forces(const tool_state_t&) { return true; }

// Applies the operators to every degradable value; values that must not be negative stay so. paced: as in StreamItem.
void change_values(contact_frame_t&, OperatorChain&, SimTime paced = {});
void change_values(world_state_t&, OperatorChain&, SimTime paced = {});
void change_values(touch_model_t&, OperatorChain&, SimTime paced = {});
void change_values(tool_state_t&, OperatorChain&, SimTime paced = {});
void change_values(contact_event_t&, OperatorChain&);

// Changes the message to "no contact". A message of poses has no such form: returns false without a change, and the message
// is not released.
bool make_zero(contact_frame_t&);
bool make_zero(world_state_t&);
bool make_zero(touch_model_t&);
bool make_zero(tool_state_t&);

}  // namespace tactus::sync
