#pragma once

#include <string>

#include "lodestar/base/site/site.hpp"
#include "lodestar/base/site/vehicle.hpp"
#include "lodestar/ros/params/param_reader.hpp"

namespace lodestar {

/// The two files that every stage of the line is set up from.
struct LineSetup {
  Site site;
  std::string site_path;
  Vehicle vehicle;
};

/// Reads the files that parameters `~site` (needed) and `~vehicle` (empty: the defaults) name. Faults of the files, and
/// of the site's tones at the vehicle file's frame rate, join the reader's.
LineSetup read_line_setup(ParamReader& params);

/// The site alone, for nodes that need no vehicle.
Site read_site(ParamReader& params);

}  // namespace lodestar
