// experiment_trials: a simulated participant answers trials of published experiments.
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "scripts/experiments/answering.h"
#include "sync/text/arguments.h"

namespace experiments = tactus::experiments;

int main(int argc, char** argv) try {
  tactus::sync::Arguments app("A simulated participant that answers trials of published experiments.");
  app.add_command(
      "answer",
      "answer the lines of stdin, one line each: 'participant INDEX SEED', then 'trial PARADIGM NUMBER "
      "[NAME=VALUE]...'");
  app.add_command("paradigms", "print the paradigms");
  app.add_command("properties", "print the properties on which each paradigm depends, with sources, as CSV");
  if (const auto help = app.parse(argc, argv)) {
    std::fputs(help->c_str(), stdout);
    return 0;
  }
  if (app.command() == "paradigms")
    for (const auto& paradigm : experiments::paradigms())
      std::printf("%-16s %s\n", paradigm.name, paradigm.summary);
  if (app.command() == "properties") std::fputs(experiments::properties_table().c_str(), stdout);
  if (app.command() == "answer") {
    experiments::TrialDesk desk;
    for (std::string line; std::getline(std::cin, line);) std::cout << desk.answer(line) << std::endl;
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "experiment_trials: %s\n", e.what());
  return 1;
}
