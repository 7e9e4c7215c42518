// Material files (.mtl): the diffuse colour and the opacity of each name.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <unordered_map>

namespace halfplane {

using MaterialTable = std::unordered_map<std::string, std::array<double, 4>>;  ///< name -> rgba, 0...255

/// Adds the materials of one file to `materials`: Kd (one number is a grey; clamped to 0...1), d, Tr = 1 - d. All else
/// in a material is passed over. Throws InputError "file:line: what; the mend".
void parse_mtl(std::string_view text, const std::string& file, MaterialTable& materials);

}  // namespace halfplane
