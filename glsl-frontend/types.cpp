#include "glsl-frontend/types.h"

namespace shadestep::frontend {

namespace {

const char* scalarName(Basic basic) {
  switch (basic) {
    case Basic::void_:
      return "void";
    case Basic::bool_:
      return "bool";
    case Basic::int_:
      return "int";
    case Basic::uint_:
      return "uint";
    case Basic::float_:
      return "float";
    case Basic::double_:
      return "double";
    case Basic::int64_:
      return "int64_t";
    case Basic::uint64_:
      return "uint64_t";
    case Basic::struct_:
    case Basic::opaque:
      break;
  }
  return "";
}

const char* vectorPrefix(Basic basic) {
  switch (basic) {
    case Basic::bool_:
      return "b";
    case Basic::int_:
      return "i";
    case Basic::uint_:
      return "u";
    case Basic::double_:
      return "d";
    case Basic::int64_:
      return "i64";
    case Basic::uint64_:
      return "u64";
    default:
      return "";
  }
}

std::string elementName(const Type& type) {
  if (type.basic == Basic::struct_) return type.members ? type.members->name : "struct";
  if (type.basic == Basic::opaque) return type.opaque_name;
  if (type.columns > 1) {
    std::string name = std::string(vectorPrefix(type.basic)) + "mat" + std::to_string(type.columns);
    return type.rows == type.columns ? name : name + "x" + std::to_string(type.rows);
  }
  if (type.rows > 1) return std::string(vectorPrefix(type.basic)) + "vec" + std::to_string(type.rows);
  return scalarName(type.basic);
}

bool sameStruct(const StructType* a, const StructType* b) {
  if (a == b) return true;
  if (!a || !b || a->name != b->name || a->members.size() != b->members.size()) return false;
  for (std::size_t i = 0; i < a->members.size(); ++i) {
    if (a->members[i].name != b->members[i].name || !(a->members[i].type == b->members[i].type)) return false;
  }
  return true;
}

bool holdsComponents(Basic basic) {
  return basic != Basic::void_ && basic != Basic::opaque;
}

void appendComponents(const Type& type, const std::string& access, std::vector<Component>& out) {
  static const char* const kSwizzle[] = {".x", ".y", ".z", ".w"};
  if (type.isArray()) {
    const Type element = type.element();
    for (int i = 0; i < type.array.front(); ++i) {
      appendComponents(element, access + "[" + std::to_string(i) + "]", out);
    }
  } else if (type.basic == Basic::struct_) {
    if (!type.members) return;
    for (const Member& member : type.members->members) {
      appendComponents(member.type, access + "." + member.name, out);
    }
  } else if (holdsComponents(type.basic)) {
    for (int column = 0; column < type.columns; ++column) {
      const std::string base = type.columns > 1 ? access + "[" + std::to_string(column) + "]" : access;
      for (int row = 0; row < type.rows; ++row) {
        out.push_back({type.rows > 1 ? base + kSwizzle[row] : base, type.basic});
      }
    }
  }
}

// Sum over the components of what `weigh` says of one component's basic type.
template <class Weigh>
int sumOverComponents(const Type& type, Weigh weigh) {
  int sum = 0;
  if (type.basic == Basic::struct_) {
    if (type.members) {
      for (const Member& member : type.members->members) sum += sumOverComponents(member.type, weigh);
    }
  } else if (holdsComponents(type.basic)) {
    sum = type.rows * type.columns * weigh(type.basic);
  }
  for (int size : type.array) sum *= size;
  return sum;
}

}  // namespace

Type Type::element() const {
  Type element = *this;
  if (!element.array.empty()) element.array.erase(element.array.begin());
  return element;
}

bool Type::operator==(const Type& other) const {
  return basic == other.basic && rows == other.rows && columns == other.columns && array == other.array &&
         opaque_name == other.opaque_name && sameStruct(members.get(), other.members.get());
}

std::string glslName(const Type& type) {
  std::string name = elementName(type);
  for (int size : type.array) name += size > 0 ? "[" + std::to_string(size) + "]" : "[]";
  return name;
}

int componentCount(const Type& type) {
  return sumOverComponents(type, [](Basic) { return 1; });
}

std::vector<Component> components(const Type& type) {
  std::vector<Component> out;
  appendComponents(type, "", out);
  return out;
}

int wordCount(const Type& type) {
  return sumOverComponents(type, [](Basic basic) {
    return basic == Basic::double_ || basic == Basic::int64_ || basic == Basic::uint64_ ? 2 : 1;
  });
}

}  // namespace shadestep::frontend
