// The `texture`, `palette` and `texels` lines of a capture.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../formats/texture.hpp"
#include "capture_text.hpp"

namespace halfplane {

/// Collects the lines of textures. A texture with texels in the capture is complete when all of them have come.
class TextureReader {
 public:
  /// `file_name`: the capture's; files of texels are searched next to it.
  explicit TextureReader(std::string_view file_name) : file_name_(file_name) {}

  /// After the word `texture`: NAME file PATH | pattern P W H | inline FORMAT W H, then [format F] [mips M].
  void read_texture(CaptureText& text, std::vector<Texture>& textures);
  /// After `palette` and `texels`: words of hex digits.
  void read_palette(CaptureText& text);
  void read_texels(CaptureText& text, std::vector<Texture>& textures);
  /// Refuses an end, or another line, while texels are missing.
  void expect_complete(const CaptureText& text) const;

 private:
  struct Inline {
    Texture texture;
    std::size_t line;
  };

  [[nodiscard]] TexelImage read_file(CaptureText& text, const std::string& name) const;

  std::string_view file_name_;
  std::optional<Inline> incomplete_;
};

/// Appends the lines of a texture, including its texels.
void write_texture(const Texture& texture, std::string& out);

/// The image of a PNG, JPEG, BMP or TGA file, 8 bits a channel. Throws InputError: "path: the error".
[[nodiscard]] TexelImage read_image_file(const std::string& path);
/// The same from its bytes; `what` names the image in messages.
[[nodiscard]] TexelImage read_image(std::string_view bytes, const std::string& what);

}  // namespace halfplane
