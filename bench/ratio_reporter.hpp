#pragma once

#include <benchmark/benchmark.h>

#include <cstdio>
#include <map>
#include <string>

namespace lodestar {

/// Prints each benchmark's time as usual, and at the end its ratio to a reference of the same run. Benchmarks are named
/// "what/case"; the reference of each case is the benchmark `reference`/case.
class RatioReporter : public benchmark::ConsoleReporter {
 public:
  explicit RatioReporter(std::string reference) : reference_(std::move(reference)) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type == Run::RT_Iteration || run.aggregate_name == "median") {
        const std::string name = run.run_name.function_name + "/" + run.run_name.args;
        times_[name] = run.GetAdjustedCPUTime();
      }
    }
  }

  void Finalize() override {
    std::printf("\nRatios to %s of the same case, median CPU time:\n", reference_.c_str());
    for (const auto& [name, time] : times_) {
      const auto slash = name.find('/');
      const auto base = times_.find(reference_ + name.substr(slash));
      if (base == times_.end() || name == base->first) continue;
      std::printf("  %-44s %10.3g\n", name.c_str(), time / base->second);
    }
  }

 private:
  std::string reference_;
  std::map<std::string, double> times_;
};

}  // namespace lodestar
