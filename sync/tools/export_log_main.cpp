// export_log: exports every channel of a log as a table, for pandas, R, MATLAB, PlotJuggler.
//
//   in   LOG...
//   out  DIR/CHANNEL.csv, DIR/tags.csv, DIR/schema.json
//
// Intact parts of a damaged log are read; damage is counted. docs/export.md describes the tables.
#include <unistd.h>

#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "sync/text/pattern.h"
#include "sync/tools/channel_table.h"
#include "sync/log/timestamped_events.h"
#include "sync/log/log_time_ranges.h"
#include "sync/log/mapped_log.h"
#include "sync/node/node_options.h"
#include "sync/text/printable.h"
#include "sync/log/recorder_types.h"

using namespace tactus;
using nlohmann::json;

namespace {

constexpr std::size_t kMaxFiles = 256;  // random bytes would create more channels than a user reads

struct ExportOptions {
  std::vector<std::string> logs;
  std::string out = ".", channels;
  double since_s = -1e18, until_s = 1e18;
  bool wide = false;
};

class Table {
 public:
  Table(std::string path, const std::string& names) : path_(std::move(path)), file_(path_, std::ios::binary) { write(names); }
  void write(const std::string& rows) {
    file_ << rows;
    rows_ += std::count(rows.begin(), rows.end(), '\n');
    if (!file_)
      throw std::runtime_error("cannot write " + path_ + "; give --out a writable folder with free space");
  }
  std::int64_t close() {
    file_.close();
    if (!file_)
      throw std::runtime_error("cannot write " + path_ + "; give --out a writable folder with free space");
    return rows_ - 1;
  }

 private:
  std::string path_;
  std::ofstream file_;
  std::int64_t rows_ = 0;
};

// A channel of one name and type.
struct Channel {
  const MessageType* type;
  std::optional<sync::WideColumns> columns;
  std::string file;
  std::unique_ptr<Table> table;
  std::int64_t messages = 0;
};

std::string file_of(std::string_view channel) {
  std::string name;
  for (const char c : channel) name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.' || c == '_' ? c : '_';
  return (name.empty() || name[0] == '.' ? "_" + name : name) + ".csv";
}

json schema_of(const Channel& c, bool wide) {
  json fields = json::array();
  const std::function<void(const MessageType&, const std::string&)> add = [&](const MessageType& in, const std::string& prefix) {
    for (const Field& f : in.fields) {
      const std::string path = prefix + std::string(f.name) + (f.count.empty() ? "" : "[]");
      if (path == "header" || (wide && !f.count.empty())) continue;
      if (const MessageType* inner = message_type(f.type)) {
        add(*inner, path + ".");
      } else {
        fields.push_back({{"field", path}, {"type", f.type}, {"unit", unit_of_path(path)}, {"meaning", f.comment}});
      }
    }
  };
  add(*c.type, "");
  return {{"type", c.type->name}, {"layout", wide ? "wide" : "long"}, {"messages", c.messages}, {"fields", fields}};
}

class Export {
 public:
  explicit Export(const ExportOptions& export_options)
      : options_(export_options), selected_(export_options.channels.empty() ? ".*" : export_options.channels) {}

  void read(const std::string& path) {
    const sync::MappedLog file(path);
    const sync::LogOrigin origin = sync::origin_of(file.bytes());
    if (!origin.known)
      throw std::runtime_error(path + " contains no message of Tactus; give the run.lcmlog of a run");
    if (!origin.recovered.empty()) std::cerr << "export_log: " << path << ": " << origin.recovered << "\n";
    sync::TableContext context(origin);
    sync::LogScanner scanner(file.bytes());
    for (sync::LogEvent event; scanner.next(event);) context.learn(event);
    sync::TagTable tags = context.tags();
    sync::TimestampedEvents events(file.bytes(), origin);
    sync::LogEvent event;
    std::int64_t seen = 0;
    for (sync::HostTime at; events.next(event, at);) {
      if (++seen % 100'000 == 0 && isatty(STDERR_FILENO)) std::cerr << "\r" << seen << " events" << std::flush;
      const double t = context.log_s(at);
      if (t >= options_.since_s && t <= options_.until_s) add(event, at, context, tags);
    }
    if (seen >= 100'000 && isatty(STDERR_FILENO)) std::cerr << "\r\033[K";
    unlisted_ += tags.unlisted();
    damaged_ += events.scanner().damaged_regions();
    damaged_bytes_ += events.scanner().damaged_bytes();
  }

  void finish() {
    json files;
    for (auto& [name, c] : channels_) {
      const std::int64_t rows = c.table->close();
      files[c.file] = schema_of(c, c.columns.has_value());
      std::cout << options_.out << "/" << c.file << ": " << c.messages << " messages, " << rows << " rows\n";
    }
    if (tags_) {
      std::cout << options_.out << "/tags.csv: " << tags_->close() << " rows\n";
      files["tags.csv"] = {{"layout", "long"}, {"columns", {"log_s", "node", "tag", "unit", "value"}}};
    }
    const auto count = [](std::int64_t n, const char* label) {
      if (n > 0) std::cout << n << " " << label << "\n";
    };
    count(foreign_, "messages of other types than those of Tactus were left out");
    count(broken_, "messages were incomplete or damaged and were left out");
    count(unlisted_, "tagged values were left out: no list in the log names them");
    if (damaged_ > 0) std::cout << damaged_ << " damaged places, " << damaged_bytes_ << " bytes in all, were skipped\n";
    std::ofstream schema(options_.out + "/schema.json");
    schema << json{{"made_by", "Tactus export_log"}, {"logs", options_.logs}, {"files", files}, {"columns", columns()}, {"foreign_messages", foreign_}, {"broken_messages", broken_}, {"damaged_regions", damaged_}, {"damaged_bytes", damaged_bytes_}}.dump(1, ' ', false, json::error_handler_t::replace) << "\n";
    schema.close();
    if (!schema)
      throw std::runtime_error("cannot write " + options_.out +
                               "/schema.json; give --out a writable folder with free space");
  }

 private:
  static json columns() {
    return {{"log_s", "s since the live part of the log began: arrival at the recorder; of tags, the instant itself"},
            {"world_s", "s since the world began: the instant that the message describes; empty: none"},
            {"sender", "process that sent it"},
            {"seq", "number of the message among those of its sender on this channel"},
            {"field", "path of the field; a list's places are counted from 0"},
            {"unit", "of the value; empty: none, or a text"},
            {"value", "number or text"}};
  }

  void add(const sync::LogEvent& event, sync::HostTime at, const sync::TableContext& context, sync::TagTable& tags) {
    const std::string name(event.channel);
    // The type descriptions of a log and LCM's self test are plain text without a type.
    if (name == sync::kLogTypes || name == "LCM_SELF_TEST") return;
    const MessageType* type = type_of(event.data);
    if (!type) {
      ++foreign_;
      return;
    }
    if (!selected_.matches(name)) return;
    if (name == channels::kTagValues) {
      if (!tags_) tags_ = std::make_unique<Table>(options_.out + "/tags.csv", sync::tag_names());
      tags_->write(sync::tag_rows(tags, context, event, at));
      return;
    }
    auto it = channels_.find(name);
    if (it == channels_.end()) {
      if (channels_.size() >= kMaxFiles) {
        ++foreign_;
        return;
      }
      it = channels_.emplace(name, Channel{.type = type, .columns = {}, .file = file_of(name), .table = {}}).first;
      Channel& c = it->second;
      if (options_.wide) c.columns.emplace(*type);
      c.table = std::make_unique<Table>(options_.out + "/" + c.file, c.columns ? c.columns->names() : sync::long_names());
    }
    Channel& c = it->second;
    const std::string rows = c.type != type ? "" : c.columns ? c.columns->row(context, event, at) : sync::long_rows(context, *type, event, at);
    if (rows.empty()) {
      ++broken_;
      return;
    }
    c.table->write(rows);
    ++c.messages;
  }

  const ExportOptions& options_;
  sync::Pattern selected_;
  std::map<std::string, Channel> channels_;
  std::unique_ptr<Table> tags_;
  std::int64_t foreign_ = 0, broken_ = 0, unlisted_ = 0, damaged_ = 0, damaged_bytes_ = 0;
};

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app{"Makes a table of every channel of a log, for pandas, R, MATLAB, PlotJuggler."};
  ExportOptions export_options;
  app.add_option("LOG", export_options.logs, "logs of one run, in order, or its folder: all parts").required().existing_path();
  app.add_option("--out", export_options.out, "folder for the tables").existing_folder().show_default();
  app.add_option("--channels", export_options.channels, "regular expression that the whole name of a channel matches; default: all");
  app.add_option("--since", export_options.since_s, "from this second of the log");
  app.add_option("--until", export_options.until_s, "up to this second of the log");
  app.add_flag("--wide", export_options.wide, "a row for each message and a column for each field, without lists, instead of a row for each value");
  sync::parse_or_exit(app, "export_log", argc, argv);
  std::optional<Export> all;
  try {
    all.emplace(export_options);
  } catch (const std::invalid_argument&) {
    throw std::runtime_error("--channels " + sync::printable(export_options.channels) + ": is not a regular expression; write for example 'TOOL_STATE|CONTACT.*'");
  }
  for (const std::string& path : export_options.logs) all->read(path);
  all->finish();
  return 0;
} catch (const std::exception& e) {
  return sync::fail("export_log", e);
}
