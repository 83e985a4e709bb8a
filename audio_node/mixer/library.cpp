#include "audio_node/mixer/library.h"

#include <filesystem>
#include <utility>

#include "sync/node/realtime.h"

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
    wanted_.reset();
    return;
  }
  wanted_ = Source{sounds_folder(settings.sounds), settings.sample_rate_Hz, settings.recorded_size_m};
}

void Library::use(Shared database) {
  std::string what =
      "recordings of " + std::to_string(database->sounds.size()) + " sounds from " + reading_->folder;
  news_.push_back(what);
  for (std::size_t i = 0; i < database->faults.size(); ++i) {
    if (i == kMaxReportedFaults) {
      news_.push_back("and " + std::to_string(database->faults.size() - i) +
                      " faults more; tactus check-sounds names them all");
      break;
    }
    news_.push_back(database->faults[i].path + " " + database->faults[i].what);
  }
  next_ = std::move(database);
}

void Library::take_read(std::vector<Shared>& unread) {
  if (!opening_ || !opening_->done()) return;
  try {
    Shared database = opening_->take();
    // Discards a database that was disabled or replaced while it was being read.
    if (wanted_ != reading_) {
      unread.push_back(std::move(database));
    } else {
      if (next_) unread.push_back(std::move(next_));
      use(std::move(database));
    }
  } catch (const std::exception& e) {
    news_.push_back("cannot read the recordings in " + reading_->folder + " (" + e.what() +
                    "); contacts are computed");
  }
  opening_.reset();
  read_ = reading_;
}

// While the callback cannot be notified, the previous database stays in use.
bool Library::tell(Shared next) {
  if (kept_.size() >= kMaxKept || !queues_.databases.push(told_ + 1)) return false;
  if (now_) kept_.push_back({told_, std::move(now_)});
  now_ = std::move(next);
  ++told_;
  return true;
}

std::vector<Library::Shared> Library::step(bool heard) {
  std::vector<Shared> unread;
  if (wanted_ && !opening_ && wanted_ != read_) {
    reading_ = wanted_;
    opening_.emplace([source = *reading_] {
      sync::leave_realtime();
      return std::make_unique<Database>(read_database(source.folder, source.rate_Hz, source.size_m));
    });
  }
  take_read(unread);
  if (!wanted_) {
    read_.reset();
    if (next_) unread.push_back(std::move(next_));
    if (now_) tell(nullptr);
  }
  if (next_ && tell(next_)) next_.reset();
  if (!heard) release_unused(queues_);
  const std::int64_t let_go = queues_.let_go.load(std::memory_order_acquire);
  while (!kept_.empty() && kept_.front().number < let_go) {
    unread.push_back(std::move(kept_.front().database));
    kept_.pop_front();
  }
  return unread;
}

}  // namespace tactus::audio
