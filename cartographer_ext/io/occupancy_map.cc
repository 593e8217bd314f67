// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/occupancy_map.h"

#include <algorithm>
#include <array>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/byte_order_mark.h"
#include "cartographer_ext/io/line_reader.h"
#include "cartographer_ext/io/tokens.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr int kUnknownGrey = 128;
constexpr int64_t kMaxSide = 65536;
constexpr int64_t kMaxCells = int64_t{1} << 28;
constexpr size_t kMaxYamlSize = 1 << 20;

// File name behind the last slash, and everything up to it.
std::string BaseName(const std::string& path) {
  const size_t slash = path.rfind('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

std::string FolderName(const std::string& path) {
  const size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash + 1);
}

struct Yaml {
  std::string image;
  std::string mode = "trinary";
  double resolution = 0.;
  Pose2 origin;
  bool negate = false;
  double occupied_threshold = 0.65;
  double free_threshold = 0.196;
};

absl::Status ParseOrigin(absl::string_view value, Pose2* origin) {
  if (!absl::ConsumePrefix(&value, "[") || !absl::ConsumeSuffix(&value, "]")) {
    return absl::InvalidArgumentError("origin must be [x, y, yaw]");
  }
  const std::vector<absl::string_view> parts = absl::StrSplit(value, ',');
  std::array<double, 3> numbers;
  if (parts.size() != numbers.size()) {
    return absl::InvalidArgumentError("origin must be [x, y, yaw]");
  }
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (!ParseFinite(absl::StripAsciiWhitespace(parts[i]), &numbers[i])) {
      return absl::InvalidArgumentError("origin must be three finite numbers");
    }
  }
  *origin = Pose2(numbers[0], numbers[1], NormalizeAngle(numbers[2]));
  return absl::OkStatus();
}

absl::Status ParseKey(absl::string_view key, absl::string_view value,
                      Yaml* yaml) {
  const auto number = [&](double* to) -> absl::Status {
    if (ParseFinite(value, to)) return absl::OkStatus();
    return absl::InvalidArgumentError(
        absl::StrCat(key, " must be a finite number"));
  };
  if (key == "image") {
    yaml->image = std::string(value);
  } else if (key == "mode") {
    yaml->mode = std::string(value);
  } else if (key == "resolution") {
    return number(&yaml->resolution);
  } else if (key == "occupied_thresh") {
    return number(&yaml->occupied_threshold);
  } else if (key == "free_thresh") {
    return number(&yaml->free_threshold);
  } else if (key == "origin") {
    return ParseOrigin(value, &yaml->origin);
  } else if (key == "negate") {
    if (value != "0" && value != "1" && value != "true" && value != "false") {
      return absl::InvalidArgumentError("negate must be 0 or 1");
    }
    yaml->negate = value == "1" || value == "true";
  }
  return absl::OkStatus();  // Other keys are of no concern.
}

// A file name as a YAML value, in quotes where it would mean something else.
std::string YamlString(const std::string& text) {
  const bool is_plain = std::all_of(text.begin(), text.end(), [](char c) {
    return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '_' ||
           c == '.' || c == '-' || c == '+' || (c & 0x80) != 0;
  });
  if (is_plain && !text.empty() && text[0] != '-') return text;
  return absl::StrCat(
      "\"",
      absl::StrReplaceAll(text,
                          {{"\\", "\\\\"}, {"\"", "\\\""}, {"\n", "\\n"}}),
      "\"");
}

// The value of a line behind its colon: without comment, quotes and escapes.
std::string YamlValue(absl::string_view text) {
  text = absl::StripAsciiWhitespace(text);
  const char quote = text.empty() ? '\0' : text[0];
  if (quote != '"' && quote != '\'') {
    const size_t comment = text.find(" #");
    return std::string(absl::StripAsciiWhitespace(text.substr(0, comment)));
  }
  std::string value;
  for (size_t i = 1; i < text.size() && text[i] != quote; ++i) {
    if (quote == '"' && text[i] == '\\' && i + 1 < text.size()) {
      ++i;
      value.push_back(text[i] == 'n' ? '\n' : text[i]);
    } else {
      value.push_back(text[i]);
    }
  }
  return value;
}

absl::StatusOr<Yaml> ReadYaml(const std::string& filename) {
  auto content = ReadFile(filename, kMaxYamlSize);
  if (!content.ok()) return content.status();
  Yaml yaml;
  int line_number = 0;
  const auto error = [&](absl::string_view what) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename, ":", line_number, ": ", what));
  };
  for (absl::string_view line :
       absl::StrSplit(WithoutByteOrderMark(*content), '\n')) {
    ++line_number;
    line = absl::StripAsciiWhitespace(line);
    if (line.empty() || line[0] == '#' || line == "---") continue;
    const size_t colon = line.find(':');
    if (colon == absl::string_view::npos) return error("expected key: value");
    const absl::Status status =
        ParseKey(absl::StripAsciiWhitespace(line.substr(0, colon)),
                 YamlValue(line.substr(colon + 1)), &yaml);
    if (!status.ok()) return error(status.message());
  }
  const auto missing = [&](absl::string_view what) {
    return absl::InvalidArgumentError(absl::StrCat(filename, ": ", what));
  };
  if (yaml.image.empty()) return missing("key image is missing");
  if (!(yaml.resolution > 0.)) {
    return missing("resolution must be a positive number");
  }
  if (yaml.mode != "trinary" && yaml.mode != "scale" && yaml.mode != "raw") {
    return missing("mode must be trinary, scale or raw");
  }
  return yaml;
}

// Grey values row by row from the top.
struct Pgm {
  int width = 0;
  int height = 0;
  int max_value = 255;
  std::vector<uint8_t> values;
};

// The next word of a PGM head, skipping blanks and comments.
absl::string_view TakeWord(absl::string_view* rest) {
  while (!rest->empty()) {
    if (rest->front() == '#') {
      rest->remove_prefix(std::min(rest->find('\n'), rest->size()));
    } else if (absl::ascii_isspace(rest->front())) {
      rest->remove_prefix(1);
    } else {
      break;
    }
  }
  size_t end = 0;
  while (end < rest->size() && !absl::ascii_isspace((*rest)[end])) ++end;
  const absl::string_view word = rest->substr(0, end);
  rest->remove_prefix(end);
  return word;
}

absl::StatusOr<Pgm> ReadPgm(const std::string& filename) {
  // In text form a value takes up to four bytes.
  auto content = ReadFile(filename, 4 * kMaxCells + 4096);
  if (!content.ok()) return content.status();
  const auto error = [&](absl::string_view what) {
    return absl::InvalidArgumentError(absl::StrCat(filename, ": ", what));
  };
  absl::string_view rest = *content;
  const absl::string_view magic = TakeWord(&rest);
  if (magic != "P5" && magic != "P2") return error("not a grey PGM picture");
  int64_t width, height, max_value;
  if (!ParseInt(TakeWord(&rest), &width) ||
      !ParseInt(TakeWord(&rest), &height) ||
      !ParseInt(TakeWord(&rest), &max_value) || width < 1 || height < 1 ||
      width > kMaxSide || height > kMaxSide || width * height > kMaxCells) {
    return error("invalid size");
  }
  if (max_value < 1 || max_value > 255) {
    return error("only 8 bit pictures are read");
  }
  Pgm pgm;
  pgm.width = static_cast<int>(width);
  pgm.height = static_cast<int>(height);
  pgm.max_value = static_cast<int>(max_value);
  const size_t size = static_cast<size_t>(width * height);
  if (magic == "P5") {
    if (!rest.empty()) rest.remove_prefix(1);  // One blank ends the head.
    if (rest.size() < size) return error("truncated");
    pgm.values.assign(rest.begin(), rest.begin() + size);
    return pgm;
  }
  if (rest.size() < size) return error("truncated");
  pgm.values.reserve(size);
  for (size_t i = 0; i < size; ++i) {
    int64_t value;
    if (!ParseInt(TakeWord(&rest), &value) || value < 0 || value > max_value) {
      return error("truncated, or a value out of range");
    }
    pgm.values.push_back(static_cast<uint8_t>(value));
  }
  return pgm;
}

// Interprets a grey value as map_server does.
float ToOccupancy(const Yaml& yaml, double grey, double max_value) {
  if (yaml.mode == "raw") {
    return grey <= 100. ? static_cast<float>(grey / 100.)
                        : OccupancyMap::Unknown();
  }
  const double occupancy =
      yaml.negate ? grey / max_value : (max_value - grey) / max_value;
  if (occupancy > yaml.occupied_threshold) return 1.f;
  if (occupancy < yaml.free_threshold) return 0.f;
  if (yaml.mode == "trinary") return OccupancyMap::Unknown();
  return static_cast<float>((occupancy - yaml.free_threshold) /
                            (yaml.occupied_threshold - yaml.free_threshold));
}

}  // namespace

OccupancyMap OccupancyMap::Make(int width, int height, double resolution,
                                const Pose2& origin) {
  OccupancyMap map;
  map.width = width;
  map.height = height;
  map.resolution = resolution;
  map.origin = origin;
  map.occupancy.assign(static_cast<size_t>(width) * height, Unknown());
  return map;
}

absl::Status WriteOccupancyMap(const OccupancyMap& map,
                               const std::string& filestem) {
  if (map.width < 1 || map.height < 1 || !(map.resolution > 0.) ||
      map.occupancy.size() != static_cast<size_t>(map.width) * map.height) {
    return absl::InvalidArgumentError(
        absl::StrCat("empty or inconsistent map for ", filestem));
  }
  AtomicFile file(absl::StrCat(filestem, ".pgm"));
  if (!file.status().ok()) return file.status();
  file.stream() << absl::StrFormat("P5\n# %.5f m a pixel\n%d %d\n255\n",
                                   map.resolution, map.width, map.height);
  for (int y = map.height - 1; y >= 0; --y) {
    std::string row;
    for (int x = 0; x < map.width; ++x) {
      const double occupancy = map.at(x, y);
      int grey = kUnknownGrey;
      if (!std::isnan(occupancy)) {
        grey = static_cast<int>(
            std::lround(255. * (1. - std::min(1., std::max(0., occupancy)))));
      }
      row.push_back(static_cast<char>(grey));
    }
    file.stream() << row;
  }
  const absl::Status status = file.Commit();
  if (!status.ok()) return status;
  return WriteFileAtomically(
      absl::StrCat(filestem, ".yaml"),
      absl::StrFormat("image: %s\n"
                      "mode: trinary\n"
                      "resolution: %s\n"
                      "origin: [%s, %s, %s]\n"
                      "negate: 0\n"
                      "occupied_thresh: 0.65\n"
                      "free_thresh: 0.196\n",
                      YamlString(BaseName(filestem) + ".pgm"),
                      FormatDouble(map.resolution), FormatDouble(map.origin.x),
                      FormatDouble(map.origin.y),
                      FormatDouble(map.origin.theta)));
}

absl::StatusOr<OccupancyMap> ReadOccupancyMap(
    const std::string& yaml_filename) {
  const auto yaml = ReadYaml(yaml_filename);
  if (!yaml.ok()) return yaml.status();
  const std::string image =
      absl::StartsWith(yaml->image, "/")
          ? yaml->image
          : absl::StrCat(FolderName(yaml_filename), yaml->image);
  const auto pgm = ReadPgm(image);
  if (pgm.status().code() == absl::StatusCode::kNotFound) {
    return absl::NotFoundError(
        absl::StrCat(yaml_filename, ": the image: ", pgm.status().message()));
  }
  if (!pgm.ok()) return pgm.status();
  OccupancyMap map = OccupancyMap::Make(pgm->width, pgm->height,
                                        yaml->resolution, yaml->origin);
  std::vector<float> table(256);
  for (int grey = 0; grey < 256; ++grey) {
    table[grey] =
        ToOccupancy(*yaml, std::min(grey, pgm->max_value), pgm->max_value);
  }
  for (int y = 0; y < map.height; ++y) {
    const size_t row = static_cast<size_t>(map.height - 1 - y) * map.width;
    for (int x = 0; x < map.width; ++x) {
      map.at(x, y) = table[pgm->values[row + x]];
    }
  }
  return map;
}

}  // namespace io
}  // namespace cartographer_ext
