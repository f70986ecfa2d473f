// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/calls/named_strings.h"

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <unordered_map>

#include "interceptor/calls/hooks.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/registry/gl_enums.h"

namespace shadestep::calls {
namespace {

using dispatch::gl;

std::mutex mutex;
std::unordered_map<std::uint64_t, std::shared_ptr<NamedStrings>>& groups() {
  // Never destroyed: the program may make GL calls from its own exit handlers.
  static auto* all = new std::unordered_map<std::uint64_t, std::shared_ptr<NamedStrings>>;
  return *all;
}

// Of the share group, not handed out to anybody; null without a context.
NamedStrings* changeable() {
  const dispatch::Context* context = dispatch::currentContext();
  if (context == nullptr) return nullptr;
  std::shared_ptr<NamedStrings>& strings = groups()[context->share_group];
  if (strings == nullptr) {
    strings = std::make_shared<NamedStrings>();
  } else if (strings.use_count() > 1) {
    strings = std::make_shared<NamedStrings>(*strings);
  }
  return strings.get();
}

GLint lengthOf(const std::string& text) {
  return static_cast<GLint>(text.size());
}

bool exists(const std::string& name) {
  return gl().IsNamedStringARB(lengthOf(name), name.c_str()) == GL_TRUE;
}

// As the driver has it. Only for names that exist: others are errors.
std::string textOf(const std::string& name) {
  GLint length = 0;  // with the null at its end
  gl().GetNamedStringivARB(lengthOf(name), name.c_str(), GL_NAMED_STRING_LENGTH_ARB, &length);
  std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
  GLint written = 0;
  gl().GetNamedStringARB(lengthOf(name), name.c_str(), lengthOf(text), &written, text.data());
  text.resize(static_cast<std::size_t>(std::clamp(written, 0, lengthOf(text))));
  return text;
}

const NamedString* find(const NamedStrings& strings, const std::string& name) {
  const auto found = std::find_if(strings.begin(), strings.end(),
                                  [&](const NamedString& string) { return string.name == name; });
  return found != strings.end() ? &*found : nullptr;
}

void change(const std::shared_ptr<const NamedStrings>& from, const std::shared_ptr<const NamedStrings>& to) {
  if (from == to) return;
  static const NamedStrings kNone;
  const NamedStrings& before = from != nullptr ? *from : kNone;
  const NamedStrings& after = to != nullptr ? *to : kNone;
  for (const NamedString& string : before) {
    if (find(after, string.name) == nullptr && exists(string.name))
      gl().DeleteNamedStringARB(lengthOf(string.name), string.name.c_str());
  }
  for (const NamedString& string : after) {
    gl().NamedStringARB(GL_SHADER_INCLUDE_ARB, lengthOf(string.name), string.name.c_str(),
                        lengthOf(*string.text), string.text->c_str());
  }
}

}  // namespace

std::shared_ptr<const NamedStrings> namedStrings() {
  const std::lock_guard lock(mutex);
  const dispatch::Context* context = dispatch::currentContext();
  if (context == nullptr) return nullptr;
  const auto found = groups().find(context->share_group);
  return found != groups().end() ? found->second : nullptr;
}

NamedStringsScope::NamedStringsScope(std::shared_ptr<const NamedStrings> wanted)
    : own_(namedStrings()), wanted_(std::move(wanted)) {
  change(own_, wanted_);
}

NamedStringsScope::~NamedStringsScope() {
  change(wanted_, own_);
}

// ---- hooks

void after_glNamedStringARB(GLenum, GLint length, const GLchar* name, GLint, const GLchar*) {
  if (name == nullptr) return;
  const std::string key =
      length < 0 ? std::string(name) : std::string(name, static_cast<std::size_t>(length));
  if (!exists(key)) return;
  const std::lock_guard lock(mutex);
  NamedStrings* strings = changeable();
  if (strings == nullptr) return;
  std::erase_if(*strings, [&](const NamedString& string) { return string.name == key; });
  strings->push_back({key, std::make_shared<const std::string>(textOf(key))});
}

// The name may be another one of the same place.
void after_glDeleteNamedStringARB(GLint, const GLchar*) {
  const std::lock_guard lock(mutex);
  NamedStrings* strings = changeable();
  if (strings != nullptr)
    std::erase_if(*strings, [](const NamedString& string) { return !exists(string.name); });
}

}  // namespace shadestep::calls
