#include "cli/command_line.hpp"

#include <iostream>

namespace lodestar {

namespace po = boost::program_options;

double duration_s(const po::variables_map& options) {
  const double value_s = options["duration"].as<double>();
  if (!(value_s > 0 && value_s <= 1e7)) {
    throw UserError("--duration is " + std::to_string(value_s) + " s, it must be above 0 s and at most 1e7 s.");
  }
  return value_s;
}

int run_tool(int argc, char** argv, const std::string& usage, po::options_description options,
             const std::function<int(const po::variables_map&)>& job) {
  options.add_options()("help,h", "show this and stop");
  po::variables_map values;
  try {
    po::store(po::parse_command_line(argc, argv, options), values);
    if (values.count("help")) {
      std::cout << usage << "\n" << options;
      return 0;
    }
    po::notify(values);
  } catch (const po::error& error) {
    std::cerr << error.what() << " (--help shows the options)\n";
    return 2;
  }
  try {
    return job(values);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}

}  // namespace lodestar
