// Tagged variables of a process, which can be recorded while it runs. One line tags one:
//
//   node.tags().add("depth", "m", &depth_m);                              // each tick
//   node.tags().add("voices", "1", [&] { return double(bank.size()); }, 10);  // ten times a second
//
// Without a request (TAG_REQUEST) no value is sampled, stored or sent. Pure: the node passes messages in and publishes the
// pending messages.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <string>
#include <tactus/tag_def_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tag_values_t.hpp>
#include <vector>

#include "sync/node/tag_requests.h"
#include "sync/time/time.h"

namespace tactus::sync {

class Tags {
 public:
  static constexpr std::size_t kMax = 1024;
  // Longest time from sampling to sending (design: a viewer's picture at 20 Hz).
  static constexpr Nanoseconds kSendPeriod{50'000'000};
  static constexpr Nanoseconds kListPeriod{1'000'000'000};
  using Getter = std::function<double()>;

  Tags(std::string node, std::int64_t run_id) : node_(std::move(node)), requests_(run_id) {}

  // rate_Hz 0: each tick. The getter is called in the node's loop; a result that is not finite means no value. Throws
  // std::invalid_argument with one sentence when the name is in use or invalid, or when there are too many tags.
  void add(std::string name, std::string unit, Getter getter, double rate_Hz = 0);
  template <class Number>
  requires std::integral<Number> || std::floating_point<Number>
  void add(std::string name, std::string unit, const Number* variable, double rate_Hz = 0) {
    add(
        std::move(name), std::move(unit), [variable] { return static_cast<double>(*variable); }, rate_Hz);
  }

  // True while a process requests values. Variables that exist only to be tagged need to be computed only then.
  bool requested() const { return !blocks_.empty(); }
  void push(const tag_request_t& request, HostTime now);
  // Once a tick: samples the due variables. Allocates nothing once a block has been filled.
  void step(HostTime now);
  // The next message to send now; null: none is left. Valid until the next call.
  tag_list_t* next_list();
  tag_values_t* next_values();

 private:
  struct Tag {
    tag_def_t def;
    Getter getter;
  };
  // Tags of one rate whose rows are sent together.
  struct Block {
    double rate_Hz;
    HostTime next{};   // when the next row is due
    HostTime first_row{};  // when the first row was sampled
    std::size_t max_rows;
    bool full = false;
    tag_values_t message{};
  };
  void build_blocks();
  void page_list();
  void append_row(Block& block, HostTime now);

  std::string node_;
  std::vector<Tag> tags_;
  std::int64_t list_ = 0;  // 0: must be recomputed
  std::vector<tag_list_t> pages_;
  std::size_t next_page_ = 0;  // pages_.size(): all sent
  HostTime list_due_{};
  TagRequests requests_;
  std::vector<Block> blocks_;
  std::size_t sent_ = 0;  // the block whose message was returned last, plus 1
};

}  // namespace tactus::sync
