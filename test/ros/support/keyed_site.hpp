#pragma once

#include <fstream>
#include <iterator>
#include <string>

#include "support/temporary_folder.hpp"

namespace lodestar::test {

/// The same site file with a key beside it, in `folder`: its path.
inline std::string keyed_site(const std::string& site_path, const TemporaryFolder& folder) {
  std::ifstream file(site_path);
  std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string link = "link: {";
  text.insert(text.find(link) + link.size(), "key_file: site.key, ");
  std::ofstream(folder / "site.key") << "000102030405060708090a0b0c0d0e0f\n";
  std::ofstream(folder / "site.yaml") << text;
  return folder / "site.yaml";
}

}  // namespace lodestar::test
