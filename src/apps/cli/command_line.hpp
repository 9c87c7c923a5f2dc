#pragma once

#include <boost/program_options.hpp>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include "lodestar/base/common/fault.hpp"
#include "lodestar/base/common/result.hpp"

namespace lodestar {

/// Something that the user can mend; shown as one line, without a trace.
struct UserError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a file held, or a UserError with all its faults.
template <class T>
T value_or_throw(Result<T, Faults> result) {
  if (!result) throw UserError(describe(result.error()) + "Mend the file, then start again.");
  return std::move(result).value();
}

/// --duration in seconds: above 0 and at most 1e7, else a UserError.
double duration_s(const boost::program_options::variables_map& options);

/// Parses the command line, answers --help, and runs `job`. Errors go to standard error.
/// @param usage what the program does, its usage line and examples; printed above the options
/// @return the exit code: job's own, 2 for a wrong command line, 1 for a UserError or another exception
int run_tool(int argc, char** argv, const std::string& usage, boost::program_options::options_description options,
             const std::function<int(const boost::program_options::variables_map&)>& job);

}  // namespace lodestar
