// Sends a request for a policy as a message, and stores the last request in a file: a restarted coordinator continues with
// it.
#pragma once

#include <filesystem>
#include <optional>
#include <tactus/playout_entry_t.hpp>
#include <tactus/playout_request_t.hpp>
#include <tactus/playout_t.hpp>
#include <vector>

#include "sync/playout/policy.h"

namespace tactus::sync {

playout_request_t request_for(const PlayoutPlan& plan, std::int64_t generation);

// Writes a plan into a playout_request_t, or into the playout_t that answers it; asynchronies are in the entries.
template <class Message>
void write_plan(Message& m, std::int64_t generation, const PlayoutPlan& plan) {
  m.header.sim_time_ns = -1;
  m.generation = generation;
  m.policy = static_cast<std::int8_t>(plan.policy);
  m.aligner = static_cast<std::int8_t>(plan.aligner);
  m.base_ns = plan.base.count();
  m.budget_ns = plan.budget.count();
}
// Splits a PLAYOUT message into as many pages as its modalities need; a node searches each page for its own modality. Entries
// with an asynchrony come first, so that the first page holds the whole plan.
std::vector<playout_t> pages_of(const playout_t& whole);
// Adds a page to the previous ones; its entries replace those of the same modalities. A page of a newer generation replaces
// all entries; a page of an older one is ignored.
void add_page(playout_t& whole, const playout_t& page);

// Both message types are range-checked by lcmtypes/valid.h.
template <class Message>
PlayoutPlan plan_of(const Message& m) {
  PlayoutPlan plan;
  plan.policy = static_cast<Policy>(m.policy);
  plan.aligner = static_cast<AlignerKind>(m.aligner);
  plan.base = Nanoseconds(m.base_ns);
  plan.budget = Nanoseconds(m.budget_ns);
  for (const playout_entry_t& e : m.entries)
    if (e.soa_ns != 0) plan.soa[e.modality] = Nanoseconds(e.soa_ns);
  return plan;
}

void store_request(const std::filesystem::path& folder, const playout_request_t& request);
// nullopt when there is no file, or when it is damaged or belongs to another run.
std::optional<playout_request_t> load_request(const std::filesystem::path& folder, std::int64_t run_id);

}  // namespace tactus::sync
