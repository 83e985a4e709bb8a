#include "audio_node/mixer/library.h"

#include <filesystem>
#include <utility>

#include "sync/node/realtime.h"
#include "sync/text/error_text.h"

namespace tactus::audio {
namespace {

constexpr std::size_t kMaxReportedFaults = 5;  // faults of one database
// Number of previous databases kept while a stopped callback might play them; newer ones wait. Design: each may
// take hundreds of MB.
constexpr std::size_t kMaxKept = 2;

}  // namespace

std::string sounds_folder(const std::string& setting) {
  if (setting != "default" && !setting.empty()) return setting;
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "sounds";
}

void Library::configure(const Settings& settings) {
  if (settings.method == "modal") {
    requested_.reset();
    return;
  }
  requested_ = Source{sounds_folder(settings.sounds), settings.sample_rate_Hz, settings.recorded_size_m};
}

void Library::set_next(Shared database) {
  std::string what =
      "recordings of " + std::to_string(database->sounds.size()) + " sounds from " + reading_->folder;
  messages_.push_back(what);
  for (std::size_t i = 0; i < database->faults.size(); ++i) {
    if (i == kMaxReportedFaults) {
      messages_.push_back("and " + std::to_string(database->faults.size() - i) +
                      " more faults; tactus check-sounds lists all of them");
      break;
    }
    messages_.push_back(database->faults[i].path + " " + database->faults[i].what);
  }
  next_ = std::move(database);
}

void Library::receive_database(std::vector<Shared>& released) {
  if (!opening_ || !opening_->done()) return;
  try {
    Shared database = opening_->take();
    // Discards a database that was disabled or replaced while it was being read.
    if (requested_ != reading_) {
      released.push_back(std::move(database));
    } else {
      if (next_) released.push_back(std::move(next_));
      set_next(std::move(database));
    }
  } catch (const std::exception& e) {
    messages_.push_back("cannot read the recordings in " + reading_->folder + " (" + sync::error_text(e) +
                    "); contact sounds are computed instead");
  }
  opening_.reset();
  read_ = reading_;
}

// While the queue to the callback is full, the previous database stays in use.
bool Library::publish_database(Shared next) {
  if (kept_.size() >= kMaxKept || !queues_.databases.push(number_ + 1)) return false;
  if (now_) kept_.push_back({number_, std::move(now_)});
  now_ = std::move(next);
  ++number_;
  return true;
}

std::vector<Library::Shared> Library::step(bool has_callback) {
  std::vector<Shared> released;
  if (requested_ && !opening_ && requested_ != read_) {
    reading_ = requested_;
    opening_.emplace([source = *reading_] {
      sync::leave_realtime();
      return std::make_unique<Database>(read_database(source.folder, source.rate_Hz, source.size_m));
    });
  }
  receive_database(released);
  if (!requested_) {
    read_.reset();
    if (next_) released.push_back(std::move(next_));
    if (now_) publish_database(nullptr);
  }
  if (next_ && publish_database(next_)) next_.reset();
  if (!has_callback) release_unused(queues_);
  const std::int64_t oldest_held = queues_.oldest_held.load(std::memory_order_acquire);
  while (!kept_.empty() && kept_.front().number < oldest_held) {
    released.push_back(std::move(kept_.front().database));
    kept_.pop_front();
  }
  return released;
}

}  // namespace tactus::audio
