// Table rows of every message of a channel, of any type: long, a row for each number or text, or wide, a row for each
// message. Pure. docs/export.md describes the columns.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/fields.h"
#include "sync/log/log_origin.h"
#include "sync/log/log_reader.h"
#include "sync/node/tag_table.h"
#include "sync/tools/log_interval.h"

namespace tactus::sync {

// The data of the columns that all tables have, collected from all messages of a log.
class TableContext {
 public:
  static constexpr std::size_t kMaxNames = 4096;

  // run: number of the run in its log, from 1: the last column of every table.
  explicit TableContext(const LogOrigin& origin, int run = 1) : origin_(origin), run_(run) {}
  // Call it once for each event of the log, before making any row: collects names of senders and lists of tags.
  void learn(const LogEvent& event);
  // Seconds since the live part of the log began.
  double log_s(HostTime arrival) const;
  // The name of the process with that hash; the hash in hexadecimal when no message contains the name.
  std::string sender(std::int32_t source) const;
  const TagTable& tags() const { return tags_; }
  const LogOrigin& origin() const { return origin_; }
  int run() const { return run_; }

 private:
  const LogOrigin& origin_;
  int run_;
  std::map<std::int32_t, std::string> names_;
  TagTable tags_;
};

// One cell by RFC 4180, a text as by csv_cell(std::string_view) of csv.h; a number is written so that it reads back unchanged.
std::string csv_cell(const Leaf& value);

// log_s, world_s, sender, seq, field, unit, value, run.
std::string long_names();
// The rows of a message; empty when it is not a complete message of the type, or holds a number that is not finite.
std::string long_rows(const TableContext& context, const MessageType& type, const LogEvent& event,
                      HostTime arrival);

// The columns of a type: the fields that every message has once, each in a column named "field (unit)". Fields within lists
// have no column.
class WideColumns {
 public:
  explicit WideColumns(const MessageType& type);
  std::string names() const;
  std::string row(const TableContext& context, const LogEvent& event, HostTime arrival) const;

 private:
  const MessageType& type_;
  std::map<std::string, std::size_t> column_;  // by path
  std::vector<std::string> paths_;
};

// log_s, node, tag, unit, value, run: of every value in a TAG_VALUES whose log_s is in the interval.
std::string tag_names();
std::string tag_rows(TagTable& tags, const TableContext& context, const LogEvent& event, HostTime arrival, const LogInterval& interval = {});

// log_s, bytes, data_hex, run: of a message of another system, whose fields are unknown.
std::string foreign_names();
std::string foreign_row(const TableContext& context, const LogEvent& event, HostTime arrival);

// The name of the table of a channel: letters, digits and - . _ of its name, the others replaced by _. A name that is in `used` gets
// a number, unless the channel is one of this system; the name is added to it.
std::string table_file_of(std::string_view channel, std::set<std::string>& used);
// The names of the other tables of an export, and of the tables of the channels of this system.
std::set<std::string> reserved_table_files();

}  // namespace tactus::sync
