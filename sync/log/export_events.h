// CSV rows of the tables that relate sound and picture to the log's time: contact events, their presentations, the sample or
// frame of the output at a time, and the maps between the clocks of several hosts. Pure.
#pragma once

#include <string>
#include <tactus/clock_map_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/frame_shown_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/sim_clock_t.hpp>

namespace tactus::sync {

// Lines of column names and of values; each ends with a newline. host_ns: CLOCK_MONOTONIC of the sender; for an event, the
// host time of its simulated time. -1: never. run: number of the run in its log, from 1.
std::string events_csv_names();
std::string csv_row(const contact_event_t& event, const sim_clock_t& clock, int run = 1);
std::string presented_csv_names();
std::string csv_row(const std::string& modality, const presentation_t&, int run = 1);
std::string media_clock_csv_names();
std::string csv_row(const media_clock_t&, int run = 1);
std::string clock_map_csv_names();
std::string csv_row(const clock_map_t&, int run = 1);
// name: of the wall's process. publish_ns is on its clock; due_ns is on the clock of sim_node's host.
std::string frame_shown_csv_names();
std::string csv_row(const std::string& name, const frame_shown_t&, int run = 1);

}  // namespace tactus::sync
