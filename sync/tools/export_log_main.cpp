// export_log: exports every channel of a log as a table, for pandas, R, MATLAB, PlotJuggler.
//
//   in   LOG...
//   out  DIR/CHANNEL.csv, DIR/tags.csv, DIR/schema.json
//
// A message that is in the log twice has one row. Intact parts of a damaged log are read; damage is counted. docs/export.md describes the tables.
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "sync/text/pattern.h"
#include "sync/tools/channel_table.h"
#include "sync/log/timestamped_events.h"
#include "sync/tools/exported_logs.h"
#include "sync/text/printable.h"
#include "sync/log/recorder_types.h"

using namespace tactus;
using nlohmann::json;

namespace {

constexpr std::size_t kMaxFiles = 256;  // random bytes would create more channels than a user reads

struct ExportOptions : sync::ExportedLogOptions {
  std::string out = ".", channels;
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
  std::string name;
  const MessageType* type;  // null: of another system
  std::optional<sync::WideColumns> columns;
  std::string file;
  std::unique_ptr<Table> table;
  std::int64_t messages = 0;
};

json schema_of(const Channel& c, bool wide) {
  const std::string name = sync::printable(c.name);
  if (!c.type) return {{"channel", name}, {"layout", "foreign"}, {"messages", c.messages}, {"columns", {"log_s", "bytes", "data_hex", "run"}}};
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
  return {{"channel", name}, {"type", c.type->name}, {"layout", wide ? "wide" : "long"}, {"messages", c.messages}, {"fields", fields}};
}

class Export {
 public:
  explicit Export(const ExportOptions& export_options)
      : options_(export_options), selected_(export_options.channels.empty() ? ".*" : export_options.channels) {}

  void read(const sync::LogIndex& index, int run) {
    const sync::LogOrigin& origin = index.run(run).origin;
    if (!origin.recovered.empty() && !options_.quiet) std::cerr << "export_log: " << sync::printable(options_.logs.front()) << ": " << origin.recovered << "\n";
    sync::TableContext context(origin, run);
    sync::LogEvent event;
    sync::HostTime at{};
    for (sync::TimestampedEvents all(index, run); all.next(event, at);) context.learn(event);
    sync::TagTable tags = context.tags();
    std::int64_t seen = 0;
    for (sync::TimestampedEvents events(index, run); events.next(event, at);) {
      if (++seen % 100'000 == 0 && isatty(STDERR_FILENO)) std::cerr << "\r" << seen << " events" << std::flush;
      // Values of tags are dated before their message arrives.
      if (event.channel == channels::kTagValues || options_.interval.contains(origin, at)) add(event, at, context, tags);
    }
    if (seen >= 100'000 && isatty(STDERR_FILENO)) std::cerr << "\r\033[K";
    unlisted_ += tags.unlisted();
  }

  void finish(const sync::LogIndex& index) {
    json files;
    for (auto& [key, c] : channels_) {
      const std::int64_t rows = c.table->close();
      files[c.file] = schema_of(c, c.columns.has_value());
      std::cout << options_.out << "/" << c.file << ": " << c.messages << " messages, " << rows << " rows\n";
    }
    if (tags_) {
      std::cout << options_.out << "/tags.csv: " << tags_->close() << " rows\n";
      files["tags.csv"] = {{"layout", "long"}, {"columns", {"log_s", "node", "tag", "unit", "value", "run"}}};
    }
    const auto count = [](std::int64_t n, const char* label) {
      if (n > 0) std::cout << n << " " << label << "\n";
    };
    count(foreign_, "messages of other systems were exported with their bytes");
    count(left_out_, "messages were left out: they are on more channels than can be exported");
    count(broken_, "messages were incomplete or damaged and were left out");
    count(unlisted_, "tagged values were left out: no list in the log names them");
    if (index.damaged_regions() > 0)
      std::cout << index.damaged_regions() << " damaged places, " << index.damaged_bytes() << " bytes in all, were skipped\n";
    json runs = json::array();
    for (std::size_t i = 0; i < index.runs().size(); ++i)
      runs.push_back({{"run", i + 1}, {"run_id", index.runs()[i].run_id}, {"scene", sync::printable(index.runs()[i].origin.info.scene)}, {"length_s", index.runs()[i].length_s()}});
    std::ofstream schema(options_.out + "/schema.json");
    schema << json{{"made_by", "Tactus export_log"}, {"logs", options_.logs}, {"runs", runs}, {"files", files}, {"columns", columns()}, {"foreign_messages", foreign_}, {"left_out_messages", left_out_}, {"broken_messages", broken_}, {"damaged_regions", index.damaged_regions()}, {"damaged_bytes", index.damaged_bytes()}}.dump(1, ' ', false, json::error_handler_t::replace) << "\n";
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
            {"value", "number or text"},
            {"run", "number of the run in its log, from 1"},
            {"data_hex", "bytes of a message of another system, two hexadecimal digits each"}};
  }

  void add(const sync::LogEvent& event, sync::HostTime at, const sync::TableContext& context, sync::TagTable& tags) {
    const std::string name(event.channel);
    // The type descriptions of a log and LCM's self test are plain text without a type.
    if (name == sync::kLogTypes || name == "LCM_SELF_TEST") return;
    if (!selected_.matches(name)) return;
    const MessageType* const type = type_of(event.data);
    if (type != type_on(name) && type_on(name)) {
      ++broken_;
      return;
    }
    if (type && name == channels::kTagValues) {
      if (!tags_) tags_ = std::make_unique<Table>(options_.out + "/tags.csv", sync::tag_names());
      tags_->write(sync::tag_rows(tags, context, event, at, options_.interval));
      return;
    }
    auto it = channels_.find({name, type});
    if (it == channels_.end()) {
      if (channels_.size() >= kMaxFiles) {
        ++left_out_;
        return;
      }
      it = channels_.emplace(std::pair(name, type), Channel{.name = name, .type = type, .columns = {}, .file = sync::table_file_of(name, files_), .table = {}}).first;
      Channel& c = it->second;
      if (type && options_.wide) c.columns.emplace(*type);
      c.table = std::make_unique<Table>(options_.out + "/" + c.file, !type ? sync::foreign_names() : c.columns ? c.columns->names() : sync::long_names());
    }
    Channel& c = it->second;
    const std::string rows = !type       ? sync::foreign_row(context, event, at)
                             : c.columns ? c.columns->row(context, event, at)
                                         : sync::long_rows(context, *type, event, at);
    if (rows.empty()) {
      ++broken_;
      return;
    }
    c.table->write(rows);
    ++c.messages;
    foreign_ += !type;
  }

  const ExportOptions& options_;
  sync::Pattern selected_;
  std::map<std::pair<std::string, const MessageType*>, Channel> channels_;
  std::set<std::string> files_ = sync::reserved_table_files();
  std::unique_ptr<Table> tags_;
  std::int64_t foreign_ = 0, left_out_ = 0, broken_ = 0, unlisted_ = 0;
};

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app{"Makes a table of every channel of a log, for pandas, R, MATLAB, PlotJuggler."};
  ExportOptions export_options;
  export_options.add_to(app);
  app.add_option("--out", export_options.out, "folder for the tables").existing_folder().show_default();
  app.add_option("--channels", export_options.channels, "regular expression that the whole name of a channel matches; default: all");
  app.add_flag("--wide", export_options.wide, "a row for each message and a column for each field, without lists, instead of a row for each value");
  sync::parse_or_exit(app, "export_log", argc, argv);
  std::optional<Export> all;
  try {
    all.emplace(export_options);
  } catch (const std::invalid_argument&) {
    throw std::runtime_error("--channels " + sync::printable(export_options.channels) + ": is not a regular expression; write for example 'TOOL_STATE|CONTACT.*'");
  }
  const sync::ExportedLogs logs(export_options, "export_log");
  const auto known = [&](int run) { return logs.index().run(run).origin.known; };
  const std::vector<int> runs = logs.runs();
  if (std::ranges::none_of(runs, known))
    throw std::runtime_error(sync::printable(export_options.logs.front()) + " contains no message of Tactus; give the run.lcmlog of a run");
  for (const int run : runs) all->read(logs.index(), run);
  all->finish(logs.index());
  return 0;
} catch (const std::exception& e) {
  return sync::fail("export_log", e);
}
