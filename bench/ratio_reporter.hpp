#pragma once

#include <benchmark/benchmark.h>

#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace lodestar {

/// Prints each benchmark's time as usual, and at the end its ratio to a reference of the same run, and whether the
/// ratios that matter reach their targets. Benchmarks are named "what/width/height/...": a case is the size of the
/// image.
class RatioReporter : public benchmark::ConsoleReporter {
 public:
  explicit RatioReporter(std::string reference) : reference_(std::move(reference)) {}

  /// The time of `what` is to be at most `limit` times that of `than`, of the same size.
  void at_most(const std::string& what, double limit, const std::string& than) {
    targets_.push_back({what, than, limit, true});
  }
  void at_least(const std::string& what, double limit, const std::string& than) {
    targets_.push_back({what, than, limit, false});
  }

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type == Run::RT_Iteration || run.aggregate_name == "median") {
        times_[{run.run_name.function_name, run.run_name.args}] = run.GetAdjustedCPUTime();
      }
    }
  }

  void Finalize() override {
    std::printf("\nRatios to %s of the same size, median CPU time:\n", reference_.c_str());
    for (const auto& [name, time] : times_) {
      const double base = time_of(reference_, name.second);
      if (base == 0 || name.first == reference_) continue;
      std::printf("  %-44s %10.3g\n", (name.first + "/" + name.second).c_str(), time / base);
    }
    std::printf("\nTargets:\n");
    for (const Target& target : targets_) {
      for (const auto& [name, time] : times_) {
        const double base = time_of(target.than, name.second);
        if (name.first != target.what || base == 0) continue;
        const double ratio = time / base;
        std::printf("  %-24s / %-24s %-10s %8.3g, at %s %3g: %s\n", target.what.c_str(), target.than.c_str(),
                    size_of(name.second).c_str(), ratio, target.at_most ? "most" : "least", target.limit,
                    (target.at_most ? ratio <= target.limit : ratio >= target.limit) ? "reached" : "MISSED");
      }
    }
  }

 private:
  struct Target {
    std::string what, than;
    double limit;
    bool at_most;
  };

  static std::string size_of(const std::string& args) { return args.substr(0, args.find('/', args.find('/') + 1)); }

  double time_of(const std::string& what, const std::string& args) const {
    const auto found = times_.find({what, size_of(args)});
    return found == times_.end() ? 0 : found->second;
  }

  std::string reference_;
  std::vector<Target> targets_;
  std::map<std::pair<std::string, std::string>, double> times_;
};

}  // namespace lodestar
