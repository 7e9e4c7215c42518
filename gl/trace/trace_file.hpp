// Reader of apitrace's files (its docs/FORMAT.markdown, versions 0 to 6, Snappy): the calls of a program, with the values of
// their arguments as they were on entry and, of results, on return.
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace halfplane::gl {

struct TraceValue {
  enum class Kind { null, integer, real, bytes, array, pointer };
  Kind kind = Kind::null;
  std::int64_t integer = 0;       ///< of enums and masks, too; the address of a pointer whose memory was not recorded
  double real = 0;                ///< of every number
  std::string bytes;              ///< memory as it was, or a string
  std::vector<TraceValue> items;  ///< of an array or a structure
};

struct TraceSignature {
  std::string function;
  std::vector<std::string> arguments;
};

struct TraceCall {
  std::uint64_t number = 0, thread = 0;
  std::shared_ptr<const TraceSignature> signature;
  std::vector<TraceValue> arguments;
  TraceValue result;

  [[nodiscard]] const std::string& function() const { return signature->function; }
  /// The first argument of one of these names; a null value when there is none.
  template <class... Name>
  [[nodiscard]] const TraceValue& argument(Name... names) const {
    for (const std::string_view name : {std::string_view(names)...})
      for (std::size_t i = 0; i < arguments.size() && i < signature->arguments.size(); ++i)
        if (signature->arguments[i] == name) return arguments[i];
    return none();
  }

 private:
  static const TraceValue& none();
};

class TraceFile {
 public:
  /// Throws InputError: no file, or none of apitrace's.
  explicit TraceFile(const std::string& path);
  /// The next call that returned; false at the end. Throws InputError for a damaged or truncated file.
  bool next(TraceCall& call);

 private:
  [[noreturn]] void fail(const std::string& what) const;
  /// Unpacks the next chunk; false at the end of the file.
  bool fill();
  std::uint8_t byte();
  void read(char* to, std::size_t size);
  std::uint64_t number();
  std::uint64_t count();
  std::string text();
  template <class T>
  T raw();
  TraceValue value(int depth = 0);
  void skip_names(bool values_are_typed);
  void skip_frame();
  std::shared_ptr<const TraceSignature> signature();
  void details(TraceCall& call);

  std::string path_;
  std::ifstream file_;
  std::string packed_, chunk_;
  std::size_t at_ = 0;
  std::uint64_t version_ = 0, calls_ = 0;
  std::map<std::uint64_t, std::shared_ptr<const TraceSignature>> signatures_;
  std::map<std::uint64_t, std::uint64_t> structures_;  ///< members
  std::map<std::uint64_t, bool> enums_, masks_, frames_;
  std::map<std::uint64_t, TraceCall> entered_;
};

}  // namespace halfplane::gl
