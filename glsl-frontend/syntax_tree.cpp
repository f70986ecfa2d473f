#include "glsl-frontend/syntax_tree.h"

#include <glslang/MachineIndependent/localintermediate.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <mutex>
#include <utility>

namespace shadestep::frontend {

namespace {

void initializeOnce() {
  static std::once_flag once;
  std::call_once(once, [] { glslang::InitializeProcess(); });
}

EShLanguage languageOf(Stage stage) {
  switch (stage) {
    case Stage::vertex:
      return EShLangVertex;
    case Stage::tess_control:
      return EShLangTessControl;
    case Stage::tess_eval:
      return EShLangTessEvaluation;
    case Stage::geometry:
      return EShLangGeometry;
    case Stage::fragment:
      return EShLangFragment;
    case Stage::compute:
      return EShLangCompute;
  }
  return EShLangFragment;
}

// Limits decide what is refused. A limit of the driver that is higher must not stop the analysis.
const TBuiltInResource& generousLimits() {
  static const TBuiltInResource kLimits = [] {
    TBuiltInResource limits = *GetDefaultResources();
    limits.maxAtomicCounterBindings = 64;
    limits.maxCombinedAtomicCounterBuffers = 64;
    limits.maxFragmentAtomicCounterBuffers = 64;
    limits.maxDualSourceDrawBuffersEXT = 8;
    // These are the sizes of built-in arrays: with glslang's own 32 their last elements are refused
    // everywhere.
    limits.maxDrawBuffers = 8;
    limits.maxLights = 8;
    limits.maxClipPlanes = 8;
    limits.maxTextureUnits = 8;
    limits.maxTextureCoords = 8;
    limits.maxTextureImageUnits = 8;  // of gl_TextureEnvColor, which drivers give gl_MaxTextureUnits elements
    return limits;
  }();
  return kLimits;
}

// ---- types
// ----------------------------------------------------------------------------------------------------

class TypeReader {
 public:
  TypeReader(Stage stage, const std::map<std::string, std::string>& renamed)
      : stage_(stage), renamed_(renamed) {}

  Type read(const glslang::TType& type) {
    Type result;
    result.basic = basicOf(type);
    if (result.basic == Basic::struct_) {
      result.members = structOf(type);
    } else if (result.basic == Basic::opaque) {
      result.opaque_name = opaqueName(type);
    } else if (type.isMatrix()) {
      result.columns = type.getMatrixCols();
      result.rows = type.getMatrixRows();
    } else if (type.isVector()) {
      result.rows = type.getVectorSize();
    }
    if (const glslang::TArraySizes* sizes = type.getArraySizes()) {
      for (int i = 0; i < sizes->getNumDims(); ++i) {
        const int size = sizes->getDimSize(i);
        const bool unsized = size == glslang::UnsizedArraySize;
        result.array.push_back(unsized ? sizeByUse(type) : size == kUnknownSize ? 0 : size);
      }
    }
    return result;
  }

  std::string usersName(const glslang::TString& name) const {
    const auto found = renamed_.find(name.c_str());
    return found == renamed_.end() ? name.c_str() : found->second;
  }

 private:
  // An array without a size is as large as the largest constant index asks for (GLSL 4.60, 4.1.9), unless its
  // size is known at run time only. The user's arrays between other stages get theirs from layouts, which
  // nobody has read here.
  int sizeByUse(const glslang::TType& type) const {
    const glslang::TArraySizes& sizes = *type.getArraySizes();
    const bool at_run_time = type.getQualifier().storage == glslang::EvqBuffer || sizes.isVariablyIndexed();
    const glslang::TBuiltInVariable built_in = type.getQualifier().builtIn;
    const bool by_use = stage_ == Stage::fragment || built_in == glslang::EbvClipDistance ||
                        built_in == glslang::EbvCullDistance;
    if (!by_use || at_run_time || sizes.isDefaultImplicitlySized()) return 0;
    return sizes.isImplicitlySized() ? sizes.getImplicitSize() : 0;
  }

  static Basic basicOf(const glslang::TType& type) {
    switch (type.getBasicType()) {
      case glslang::EbtVoid:
        return Basic::void_;
      case glslang::EbtBool:
        return Basic::bool_;
      case glslang::EbtInt:
        return Basic::int_;
      case glslang::EbtUint:
        return Basic::uint_;
      case glslang::EbtFloat:
        return Basic::float_;
      case glslang::EbtDouble:
        return Basic::double_;
      case glslang::EbtInt64:
        return Basic::int64_;
      case glslang::EbtUint64:
        return Basic::uint64_;
      case glslang::EbtStruct:
      case glslang::EbtBlock:
        return Basic::struct_;
      default:
        return Basic::opaque;  // samplers, images, atomic counters; and widths that we cannot capture
    }
  }

  static std::string opaqueName(const glslang::TType& type) {
    if (type.getBasicType() == glslang::EbtSampler) return type.getSampler().getString().c_str();
    if (type.getBasicType() == glslang::EbtAtomicUint) return "atomic_uint";
    return type.getBasicTypeString().c_str();
  }

  // glslang gives gl_in and gl_out members that only a vendor's extension declares.
  static bool isVendors(const std::string& member) {
    return member.starts_with("gl_") && member.ends_with("NV");
  }

  std::shared_ptr<const StructType> structOf(const glslang::TType& type) {
    const glslang::TTypeList* list = type.getStruct();
    std::shared_ptr<const StructType>& known = structs_[list];
    if (!known) {
      auto made = std::make_shared<StructType>();
      made->name = usersName(type.getTypeName());
      for (const glslang::TTypeLoc& member : *list) {
        const std::string name = usersName(member.type->getFieldName());
        if (!isVendors(name)) made->members.push_back({name, read(*member.type)});
      }
      known = std::move(made);
    }
    return known;
  }

  Stage stage_;
  const std::map<std::string, std::string>& renamed_;
  std::map<const glslang::TTypeList*, std::shared_ptr<const StructType>> structs_;
};

// ---- the tree
// -------------------------------------------------------------------------------------------------

bool isAssignment(glslang::TOperator op) {
  return op >= glslang::EOpAssign && op <= glslang::EOpRightShiftAssign;
}

bool isIncrement(glslang::TOperator op) {
  return op >= glslang::EOpPostIncrement && op <= glslang::EOpPreDecrement;
}

bool isAccessPath(glslang::TOperator op) {
  return op == glslang::EOpIndexDirect || op == glslang::EOpIndexIndirect ||
         op == glslang::EOpIndexDirectStruct || op == glslang::EOpVectorSwizzle ||
         op == glslang::EOpMatrixSwizzle;
}

// Needs the neighbouring fragments' values: an explicit derivative or a texture's level of detail.
bool takesDerivatives(glslang::TOperator op) {
  if (op >= glslang::EOpDPdx && op <= glslang::EOpFwidthCoarse) return true;
  switch (op) {
    case glslang::EOpTextureQueryLod:
    case glslang::EOpTexture:
    case glslang::EOpTextureProj:
    case glslang::EOpTextureOffset:
    case glslang::EOpTextureProjOffset:
    case glslang::EOpTextureClamp:
    case glslang::EOpTextureOffsetClamp:
    case glslang::EOpSparseTexture:
    case glslang::EOpSparseTextureOffset:
    case glslang::EOpSparseTextureClamp:
    case glslang::EOpSparseTextureOffsetClamp:
      return true;
    default:
      return false;
  }
}

bool storesToMemory(glslang::TOperator op) {
  if (op >= glslang::EOpAtomicAdd && op <= glslang::EOpAtomicCompSwap) return true;
  if (op == glslang::EOpAtomicStore) return true;
  if (op >= glslang::EOpAtomicCounterIncrement && op <= glslang::EOpAtomicCounterCompSwap) {
    return op != glslang::EOpAtomicCounter;
  }
  if (op == glslang::EOpImageStore || op == glslang::EOpImageStoreLod || op == glslang::EOpImageAtomicStore)
    return true;
  return op >= glslang::EOpImageAtomicAdd && op <= glslang::EOpImageAtomicCompSwap;
}

class TreeReader {
 public:
  TreeReader(Stage stage, const AnalysedText& text, bool with_meanings, SyntaxFacts& facts)
      : text_(text), with_meanings_(with_meanings), facts_(facts), types_(stage, text.renamed) {}

  void readRoot(TIntermNode* root) {
    glslang::TIntermAggregate* sequence = root ? root->getAsAggregate() : nullptr;
    if (!sequence) return;
    for (TIntermNode* node : sequence->getSequence()) {
      glslang::TIntermAggregate* aggregate = node->getAsAggregate();
      if (aggregate && aggregate->getOp() == glslang::EOpLinkerObjects) {
        readGlobals(*aggregate);
      } else if (aggregate && aggregate->getOp() == glslang::EOpFunction) {
        readFunction(*aggregate);
      } else {
        read(node);
      }
    }
  }

 private:
  void readGlobals(glslang::TIntermAggregate& objects) {
    for (TIntermNode* node : objects.getSequence()) {
      const glslang::TIntermSymbol* symbol = node->getAsSymbolNode();
      if (!symbol) continue;
      const Type type = types_.read(symbol->getType());
      const bool nameless = isNamelessBlock(*symbol);
      if (!nameless) facts_.globals[types_.usersName(symbol->getName())] = type;
      if (symbol->getQualifier().isWriteOnly()) facts_.unreadable.insert(types_.usersName(symbol->getName()));
      if (symbol->getBasicType() == glslang::EbtBlock) readMembers(*symbol, nameless);
    }
  }

  // The members of a nameless block are variables of their own; of another one, a member may spoil the whole.
  void readMembers(const glslang::TIntermSymbol& block, bool nameless) {
    for (const glslang::TTypeLoc& member : *block.getType().getStruct()) {
      const std::string name = types_.usersName(nameless ? member.type->getFieldName() : block.getName());
      if (nameless) facts_.globals[name] = types_.read(*member.type);
      const bool write_only = member.type->getQualifier().isWriteOnly() || block.getQualifier().isWriteOnly();
      if (write_only) facts_.unreadable.insert(name);
    }
  }

  void readFunction(glslang::TIntermAggregate& function) {
    const glslang::TString& mangled = function.getName();
    facts_.definitions.push_back({types_.usersName(mangled.substr(0, mangled.find('('))), mangled.c_str(),
                                  types_.read(function.getType())});
    for (TIntermNode* node : function.getSequence()) {
      const glslang::TIntermAggregate* aggregate = node ? node->getAsAggregate() : nullptr;
      if (!aggregate || aggregate->getOp() != glslang::EOpParameters) read(node);
    }
  }

  static bool isNamelessBlock(const glslang::TIntermSymbol& symbol) {
    return symbol.getName().compare(0, 5, "anon@") == 0;
  }

  LineOrigin originOf(const TIntermNode& node) const {
    const int line = node.getLoc().line;
    if (line < 1 || line > static_cast<int>(text_.lines.size())) return {};
    return text_.lines[static_cast<std::size_t>(line) - 1];
  }

  void read(TIntermNode* node) {
    if (!node || isMention(*node)) return;
    if (!facts_.watched && startsWatched(*node)) {
      readWatched(*node->getAsTyped());
      return;
    }
    if (with_meanings_) noteMeaning(*node);
    if (glslang::TIntermSymbol* symbol = node->getAsSymbolNode()) {
      access(*symbol, symbol->getType(), true, false);
    } else if (glslang::TIntermBinary* binary = node->getAsBinaryNode()) {
      readBinary(*binary);
    } else if (glslang::TIntermUnary* unary = node->getAsUnaryNode()) {
      noteTraits(unary->getOp());
      if (isIncrement(unary->getOp())) {
        target(*unary->getOperand(), true, true);
      } else {
        read(unary->getOperand());
      }
    } else if (glslang::TIntermAggregate* aggregate = node->getAsAggregate()) {
      readAggregate(*aggregate);
    } else {
      readStatement(*node);
    }
  }

  void noteMeaning(TIntermNode& node) {
    const glslang::TIntermTyped* typed = node.getAsTyped();
    const TokenIndex token = originOf(node).token;
    if (!typed || token == kNone) return;
    const glslang::TIntermOperator* operation = node.getAsOperator();
    const glslang::TIntermAggregate* aggregate = node.getAsAggregate();
    Type type = types_.read(typed->getType());
    type.array.clear();
    const std::string callee = aggregate ? aggregate->getName().c_str() : "";
    facts_.meanings.push_back({token, operation ? operation->getOp() : 0, callee + " " + glslName(type)});
  }

  bool isMention(TIntermNode& node) {
    const glslang::TIntermTyped* typed = node.getAsTyped();
    if (!typed || node.getAsAggregate()) return false;
    const LineOrigin origin = originOf(node);
    if (origin.mentions == kNone) return false;
    facts_.mentioned[origin.mentions] = types_.read(typed->getType());
    return true;
  }

  // The outermost node of the watched expression; what holds it has no value.
  bool startsWatched(TIntermNode& node) const {
    const glslang::TIntermTyped* typed = node.getAsTyped();
    const glslang::TIntermAggregate* aggregate = node.getAsAggregate();
    const bool statements =
        aggregate && (aggregate->getOp() == glslang::EOpSequence || aggregate->getOp() == glslang::EOpNull);
    return typed && !statements && typed->getBasicType() != glslang::EbtVoid && originOf(node).watched;
  }

  void readWatched(glslang::TIntermTyped& node) {
    facts_.watched.emplace(WatchedFacts{types_.read(node.getType()), false});
    const std::size_t calls = facts_.calls.size();
    const auto accesses = static_cast<std::ptrdiff_t>(facts_.accesses.size());
    const bool wrote = std::exchange(facts_.writes_memory, false);
    read(&node);
    facts_.watched->has_effect = facts_.writes_memory || facts_.calls.size() > calls ||
                                 std::any_of(facts_.accesses.begin() + accesses, facts_.accesses.end(),
                                             [](const VariableAccess& access) { return access.write; });
    facts_.writes_memory |= wrote;
  }

  void readStatement(TIntermNode& node) {
    if (glslang::TIntermSelection* selection = node.getAsSelectionNode()) {
      read(selection->getCondition());
      read(selection->getTrueBlock());
      read(selection->getFalseBlock());
    } else if (glslang::TIntermSwitch* choice = node.getAsSwitchNode()) {
      read(choice->getCondition());
      read(choice->getBody());
    } else if (glslang::TIntermLoop* loop = node.getAsLoopNode()) {
      read(loop->getTest());
      read(loop->getBody());
      read(loop->getTerminal());
    } else if (glslang::TIntermBranch* branch = node.getAsBranchNode()) {
      noteLabel(*branch);
      read(branch->getExpression());
    }
  }

  void noteLabel(glslang::TIntermBranch& branch) {
    const glslang::TIntermTyped* value =
        branch.getFlowOp() == glslang::EOpCase ? branch.getExpression() : nullptr;
    const glslang::TIntermConstantUnion* constant = value ? value->getAsConstantUnion() : nullptr;
    const TokenIndex token = originOf(branch).token;
    if (!constant || token == kNone) return;
    if (constant->getBasicType() == glslang::EbtInt)
      facts_.labels[token] = constant->getConstArray()[0].getIConst();
    else if (constant->getBasicType() == glslang::EbtUint)
      facts_.labels[token] = constant->getConstArray()[0].getUConst();
  }

  void readBinary(glslang::TIntermBinary& binary) {
    const glslang::TOperator op = binary.getOp();
    if (isAssignment(op)) {
      target(*binary.getLeft(), op != glslang::EOpAssign, true);
      read(binary.getRight());
    } else if (isAccessPath(op)) {
      target(binary, true, false);
    } else {
      read(binary.getLeft());
      read(binary.getRight());
    }
  }

  // The variable at the root of an access path is read or written; indices on the way are read.
  void target(glslang::TIntermTyped& node, bool is_read, bool is_written) {
    glslang::TIntermBinary* binary = node.getAsBinaryNode();
    if (glslang::TIntermSymbol* symbol = node.getAsSymbolNode()) {
      access(*symbol, symbol->getType(), is_read, is_written);
    } else if (binary && isAccessPath(binary->getOp())) {
      glslang::TIntermSymbol* block = binary->getLeft()->getAsSymbolNode();
      if (block && isNamelessBlock(*block)) {
        access(*block, binary->getType(), is_read, is_written);
      } else {
        target(*binary->getLeft(), is_read, is_written);
        read(binary->getRight());
      }
    } else {
      read(&node);
    }
  }

  void access(const glslang::TIntermSymbol& symbol, const glslang::TType& type, bool is_read,
              bool is_written) {
    VariableAccess access;
    access.token = originOf(symbol).token;
    access.read = is_read;
    access.write = is_written;
    access.symbol = symbol.getId();
    access.of_block = isNamelessBlock(symbol);
    access.type = types_.read(type);
    if (access.token != kNone) facts_.accesses.push_back(std::move(access));
  }

  void readAggregate(glslang::TIntermAggregate& aggregate) {
    const glslang::TOperator op = aggregate.getOp();
    noteTraits(op);
    if (op == glslang::EOpFunctionCall && aggregate.isUserDefined()) {
      noteCall(aggregate);
    }
    const glslang::TQualifierList& qualifiers = aggregate.getQualifierList();
    const glslang::TIntermSequence& arguments = aggregate.getSequence();
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const glslang::TStorageQualifier qualifier = i < qualifiers.size() ? qualifiers[i] : glslang::EvqIn;
      glslang::TIntermTyped* argument = arguments[i] ? arguments[i]->getAsTyped() : nullptr;
      if (argument && (qualifier == glslang::EvqOut || qualifier == glslang::EvqInOut)) {
        target(*argument, qualifier == glslang::EvqInOut, true);
      } else {
        read(arguments[i]);
      }
    }
  }

  void noteCall(glslang::TIntermAggregate& aggregate) {
    UserCall call{
        originOf(aggregate).token, aggregate.getName().c_str(), types_.read(aggregate.getType()), {}};
    for (TIntermNode* argument : aggregate.getSequence()) {
      const glslang::TIntermTyped* typed = argument ? argument->getAsTyped() : nullptr;
      call.arguments.push_back(typed ? types_.read(typed->getType()) : Type());
    }
    facts_.calls.push_back(std::move(call));
  }

  void noteTraits(glslang::TOperator op) {
    facts_.uses_derivatives |= takesDerivatives(op);
    facts_.writes_memory |= storesToMemory(op);
  }

  const AnalysedText& text_;
  bool with_meanings_;
  SyntaxFacts& facts_;
  TypeReader types_;
};

// "ERROR: 0:12: 'x' : undeclared identifier" -> message and token.
void readError(const char* log, const AnalysedText& text, SyntaxFacts& facts) {
  std::string message = log ? log : "";
  const std::size_t start = message.find("ERROR: ");
  if (start != std::string::npos) message.erase(0, start + 7);
  message = message.substr(0, message.find('\n'));
  const std::size_t colon = message.find(':');
  if (colon != std::string::npos) {
    int line = 0;
    const char* first = message.data() + colon + 1;
    const auto [end, status] = std::from_chars(first, message.data() + message.size(), line);
    if (status == std::errc() && line >= 1 && line <= static_cast<int>(text.lines.size())) {
      facts.error_token = text.lines[static_cast<std::size_t>(line) - 1].token;
      facts.error_watched = text.lines[static_cast<std::size_t>(line) - 1].watched;
      message.erase(0, static_cast<std::size_t>(end - message.data()));
      message.erase(0, message.find_first_not_of(": "));
    }
  }
  while (!message.empty() && message.back() == ' ') message.pop_back();
  facts.error = message.empty() ? "glslang gives no reason" : message;
}

}  // namespace

SyntaxFacts readSyntaxTree(Stage stage, const AnalysedText& text, bool with_meanings) {
  initializeOnce();
  SyntaxFacts facts;
  glslang::TShader shader(languageOf(stage));
  const char* string = text.text.c_str();
  shader.setStrings(&string, 1);
  const auto messages =
      static_cast<EShMessages>(EShMsgRelaxedErrors | EShMsgSuppressWarnings | EShMsgKeepUncalled);
  const bool taken = shader.parse(&generousLimits(), text.es ? 100 : 110, false, messages);
  if (!taken) {
    readError(shader.getInfoLog(), text, facts);
    return facts;
  }
  facts.early_fragment_tests = shader.getIntermediate()->getEarlyFragmentTests();
  TreeReader(stage, text, with_meanings, facts).readRoot(shader.getIntermediate()->getTreeRoot());
  return facts;
}

}  // namespace shadestep::frontend
