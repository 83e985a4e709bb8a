#include "sim_node/command/state_store.h"

#include <algorithm>
#include <fstream>

#include "sync/node/realtime.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::sim {
namespace {

StateStore::Done write(const std::filesystem::path& file, const StateStore::Bytes& bytes) {
  const std::filesystem::path temporary = file.string() + ".new";
  std::ofstream out(temporary, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(temporary, file, error);
  if (!out || error) return {{}, "the file " + file.string() + " cannot be written"};
  return {};
}

StateStore::Done read(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    return {{}, "no state is stored under this name, and there is no file " + file.string()};
  try {
    return {sync::read_regular_file(file, StateStore::kMaxBytes), {}};
  } catch (const std::runtime_error& e) {
    return {{}, "the file " + file.string() + " cannot be read: " + e.what()};
  }
}

}  // namespace

bool StateStore::valid_name(const std::string& name) {
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

bool StateStore::add(const std::string& name, Bytes bytes) {
  if (!states_.contains(name) && states_.size() >= kMax) return false;
  states_[name] = std::make_shared<const Bytes>(std::move(bytes));
  return true;
}

const StateStore::Bytes* StateStore::find(const std::string& name) const {
  const auto it = states_.find(name);
  return it == states_.end() ? nullptr : it->second.get();
}

void StateStore::begin_write(const std::string& name) {
  work_.emplace([file = file_of(name), bytes = states_.at(name)] {
    sync::leave_realtime();
    return std::make_unique<Done>(write(file, *bytes));
  });
}

void StateStore::begin_read(const std::string& name) {
  work_.emplace([file = file_of(name)] {
    sync::leave_realtime();
    return std::make_unique<Done>(read(file));
  });
}

std::optional<StateStore::Done> StateStore::poll() {
  if (!work_ || !work_->done()) return std::nullopt;
  Done done = std::move(*work_->take());
  work_.reset();
  return done;
}

}  // namespace tactus::sim
