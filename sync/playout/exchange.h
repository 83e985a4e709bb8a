// A request for a policy as a message, and the last one kept in a file: a coordinator that was killed comes back
// with what somebody asked for.
#pragma once

#include <filesystem>
#include <optional>
#include <tactus/playout_request_t.hpp>

#include "sync/playout/policy.h"

namespace tactus::sync {

playout_request_t request_for(const PlayoutPlan& plan, std::int64_t generation);

void keep_request(const std::filesystem::path& folder, const playout_request_t& request);
// None when there is none, it is damaged, or it is of another run.
std::optional<playout_request_t> kept_request(const std::filesystem::path& folder, std::int64_t run_id);

}  // namespace tactus::sync
