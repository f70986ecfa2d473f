#include "nrrd.h"

#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

namespace raycaster {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw std::runtime_error("the NRRD header " + why);
}

// The names that the format allows for one type.
std::string canonicalType(const std::string& name) {
  static const std::map<std::string, std::string> names = {
      {"signed char", "int8"},      {"int8", "int8"},
      {"int8_t", "int8"},           {"uchar", "uint8"},
      {"unsigned char", "uint8"},   {"uint8", "uint8"},
      {"uint8_t", "uint8"},         {"short", "int16"},
      {"short int", "int16"},       {"signed short", "int16"},
      {"int16", "int16"},           {"int16_t", "int16"},
      {"ushort", "uint16"},         {"uint16", "uint16"},
      {"unsigned short", "uint16"}, {"unsigned short int", "uint16"},
      {"uint16_t", "uint16"},       {"int", "int32"},
      {"signed int", "int32"},      {"int32", "int32"},
      {"int32_t", "int32"},         {"uint", "uint32"},
      {"unsigned int", "uint32"},   {"uint32", "uint32"},
      {"uint32_t", "uint32"},       {"float", "float"},
      {"double", "double"}};
  const auto found = names.find(name);
  if (found == names.end()) refuse("has the type '" + name + "', which is not one of the scalar types");
  return found->second;
}

template <class Number>
Eigen::Matrix<Number, 3, 1> three(const std::string& field, const std::string& text) {
  std::istringstream stream(text);
  Eigen::Matrix<Number, 3, 1> values;
  for (Number& value : values)
    if (!(stream >> value)) refuse("needs three numbers in '" + field + "', and has '" + text + "'");
  return values;
}

// "(1,0,0) (0,1,0) (0,0,2)" -> the lengths of the three vectors.
Eigen::Vector3d lengths(std::string text) {
  for (char& c : text)
    if (c == '(' || c == ')' || c == ',') c = ' ';
  std::istringstream stream(text);
  Eigen::Vector3d result;
  for (double& length : result) {
    Eigen::Vector3d direction;
    for (double& component : direction)
      if (!(stream >> component)) refuse("needs three vectors in 'space directions'");
    length = direction.norm();
  }
  return result;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  const auto last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

void set(NrrdHeader& header, const std::string& field, const std::string& value) {
  if (field == "dimension") {
    if (value != "3") refuse("says dimension " + value + "; only volumes of dimension 3 can be shown");
  } else if (field == "sizes") {
    header.size = three<int>(field, value);
  } else if (field == "type") {
    header.type = canonicalType(value);
  } else if (field == "encoding") {
    if (value == "raw")
      header.encoding = NrrdHeader::Encoding::raw;
    else if (value == "ascii" || value == "text" || value == "txt")
      header.encoding = NrrdHeader::Encoding::text;
    else if (value == "gzip" || value == "gz")
      header.encoding = NrrdHeader::Encoding::gzip;
    else
      refuse("has the encoding '" + value + "'; save it with raw, text or gzip encoding");
  } else if (field == "endian") {
    header.bigEndian = value == "big";
  } else if (field == "spacings") {
    header.spacing = three<double>(field, value);
  } else if (field == "space directions") {
    header.spacing = lengths(value);
  } else if (field == "data file" || field == "datafile") {
    if (value == "LIST" || value.find('%') != std::string::npos)
      refuse("spreads the data over several files; join them into one");
    header.dataFile = value;
  } else if (field == "byte skip" || field == "byteskip" || field == "line skip" || field == "lineskip") {
    if (value != "0") refuse("asks to skip parts of the data, which is not supported; save it anew");
  }
  // Other fields say nothing that a picture needs.
}

}  // namespace

NrrdHeader parseNrrd(std::string_view file) {
  if (file.substr(0, 4) != "NRRD") refuse("does not begin with NRRD; is this an NRRD file?");
  NrrdHeader header;
  std::size_t at = 0;
  bool ended = false;
  while (!ended && at < file.size()) {
    const std::size_t end = file.find('\n', at);
    if (end == std::string_view::npos) break;
    const std::string line = trimmed(std::string(file.substr(at, end - at)));
    at = end + 1;
    ended = line.empty();
    const auto colon = line.find(": ");
    if (!ended && line[0] != '#' && colon != std::string::npos)
      set(header, line.substr(0, colon), trimmed(line.substr(colon + 2)));
  }
  if (!ended && header.dataFile.empty()) refuse("has no end; the file is cut off");
  header.headerBytes = at;
  if (header.type.empty()) refuse("has no 'type'");
  if (header.size == Eigen::Vector3i::Zero()) refuse("has no 'sizes'");
  for (const double length : header.spacing)
    if (!std::isfinite(length) || length <= 0) refuse("has a voxel spacing that is not a positive number");
  return header;
}

}  // namespace raycaster
