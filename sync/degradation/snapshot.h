// What a degradation needs to know of each kind of snapshot on the bus: which it is, its signals, its values, and
// what it is when nothing is felt, heard or seen. Pure.
#pragma once

#include <cstdint>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "sync/degradation/operator_chain.h"

namespace tactus::sync {

// What all pages of one snapshot have in common and no other snapshot has. Those of bodies and contacts while the
// world stands still say the same, and are one.
std::uint64_t snapshot_key(const contact_frame_t&);
std::uint64_t snapshot_key(const world_state_t&);
std::uint64_t snapshot_key(const touch_model_t&);
std::uint64_t snapshot_key(const tool_state_t&);

// Whose sequence a snapshot belongs to: what takes turns on one channel is several.
std::uint64_t stream_of(const contact_frame_t&);
std::uint64_t stream_of(const world_state_t&);
std::uint64_t stream_of(const touch_model_t&);
std::uint64_t stream_of(const tool_state_t&);

// Forces and velocities by contact, body or plane; of one page.
std::vector<Signal> signals_of(const contact_frame_t&);
std::vector<Signal> signals_of(const world_state_t&);
std::vector<Signal> signals_of(const touch_model_t&);
std::vector<Signal> signals_of(const tool_state_t&);

// Passes every value that may be degraded through the stack; what must not be negative stays so.
void change_values(contact_frame_t&, OperatorChain&);
void change_values(world_state_t&, OperatorChain&);
void change_values(touch_model_t&, OperatorChain&);
void change_values(tool_state_t&, OperatorChain&);
void change_values(contact_event_t&, OperatorChain&);

// Nothing touches. False, and nothing is changed: there is no such thing as no pose, so such a message is not let through.
bool make_zero(contact_frame_t&);
bool make_zero(world_state_t&);
bool make_zero(touch_model_t&);
bool make_zero(tool_state_t&);

}  // namespace tactus::sync
