// The compiler plugin: programs to object files with LLVM, object files to callable functions. C
// API of LLVM 14 to 19.
#include <llvm-c/Analysis.h>
#include <llvm-c/Core.h>
#include <llvm-c/Error.h>
#include <llvm-c/LLJIT.h>
#include <llvm-c/Orc.h>
#include <llvm-c/Target.h>
#include <llvm-c/TargetMachine.h>
#include <llvm-c/Transforms/PassBuilder.h>
#include <llvm/Config/llvm-config.h>
#include <stdlib.h>
#include <string.h>

#include "jit/llvm_emit.h"

static void tell(char* message, size_t room, const char* what, const char* why) {
  snprintf(message, room, "%s: %s", what, why ? why : "no reason given");
}

static bool failed(LLVMErrorRef error, char* message, size_t room, const char* what) {
  if (!error) return false;
  char* why = LLVMGetErrorMessage(error);
  tell(message, room, what, why);
  LLVMDisposeErrorMessage(why);
  return true;
}

// ------------------------------------------------------------------------------------------ target
static void initialise(void) {
  static bool done = false;
  if (done) return;
  LLVMInitializeNativeTarget();
  LLVMInitializeNativeAsmPrinter();
  done = true;
}

static LLVMTargetMachineRef make_machine(char* message, size_t room) {
  initialise();
  char *triple = LLVMGetDefaultTargetTriple(), *cpu = LLVMGetHostCPUName(),
       *features = LLVMGetHostCPUFeatures(), *why = NULL;
  LLVMTargetRef target;
  LLVMTargetMachineRef machine = NULL;
  if (LLVMGetTargetFromTriple(triple, &target, &why)) {
    tell(message, room, triple, why);
    LLVMDisposeMessage(why);
  } else {
    machine = LLVMCreateTargetMachine(target, triple, cpu, features, LLVMCodeGenLevelLess,
                                      LLVMRelocPIC, LLVMCodeModelDefault);
    if (!machine) tell(message, room, triple, "no machine");
  }
  LLVMDisposeMessage(triple);
  LLVMDisposeMessage(cpu);
  LLVMDisposeMessage(features);
  return machine;
}

static const char* describe(void) {
  static char text[4096];
  if (!text[0]) {
    char *cpu = LLVMGetHostCPUName(), *features = LLVMGetHostCPUFeatures();
    snprintf(text, sizeof text, "LLVM %s %s %s", LLVM_VERSION_STRING, cpu, features);
    LLVMDisposeMessage(cpu);
    LLVMDisposeMessage(features);
  }
  return text;
}

// --------------------------------------------------------------------------------------- compiling
static bool write_object(LLVMModuleRef module, LLVMTargetMachineRef machine, unsigned char** object,
                         size_t* size, char* message, size_t room) {
  char* why = NULL;
  LLVMMemoryBufferRef buffer = NULL;
  LLVMPassBuilderOptionsRef options = LLVMCreatePassBuilderOptions();
  bool bad = failed(LLVMRunPasses(module, "always-inline,function(early-cse)", machine, options),
                    message, room, "early-cse");
  LLVMDisposePassBuilderOptions(options);
  if (bad) return false;
  if (LLVMTargetMachineEmitToMemoryBuffer(machine, module, LLVMObjectFile, &why, &buffer)) {
    tell(message, room, "compiling", why);
    LLVMDisposeMessage(why);
    return false;
  }
  *size = LLVMGetBufferSize(buffer);
  *object = malloc(*size);
  if (*object) memcpy(*object, LLVMGetBufferStart(buffer), *size);
  else tell(message, room, "compiling", "no memory");
  LLVMDisposeMemoryBuffer(buffer);
  return *object != NULL;
}

static bool compile(const pl_prog* const* progs, int n, unsigned char** object, size_t* size,
                    char* message, size_t room) {
  LLVMTargetMachineRef machine = make_machine(message, room);
  if (!machine) return false;
  LLVMContextRef context = LLVMContextCreate();
  LLVMModuleRef module = LLVMModuleCreateWithNameInContext("pleuel", context);
  char *triple = LLVMGetTargetMachineTriple(machine), *why = NULL;
  LLVMTargetDataRef layout = LLVMCreateTargetDataLayout(machine);
  LLVMSetTarget(module, triple);
  LLVMSetModuleDataLayout(module, layout);
  for (int i = 0; i < n; i++) pl_llvm_emit(context, module, progs[i]);
  bool fine = !LLVMVerifyModule(module, LLVMReturnStatusAction, &why);
  if (!fine) tell(message, room, "program", why);
  LLVMDisposeMessage(why);
  fine = fine && write_object(module, machine, object, size, message, room);
  LLVMDisposeMessage(triple);
  LLVMDisposeTargetData(layout);
  LLVMDisposeModule(module);
  LLVMContextDispose(context);
  LLVMDisposeTargetMachine(machine);
  return fine;
}

static void release(unsigned char* object) { free(object); }

// ----------------------------------------------------------------------------------------- loading
static bool link_object(LLVMOrcLLJITRef jit, const unsigned char* object, size_t size,
                        char* message, size_t room) {
  LLVMOrcJITDylibRef library = LLVMOrcLLJITGetMainJITDylib(jit);
  LLVMOrcDefinitionGeneratorRef process = NULL;
  LLVMErrorRef error = LLVMOrcCreateDynamicLibrarySearchGeneratorForProcess(
      &process, LLVMOrcLLJITGetGlobalPrefix(jit), NULL, NULL);
  if (failed(error, message, room, "symbols")) return false;
  LLVMOrcJITDylibAddGenerator(library, process);
  LLVMMemoryBufferRef buffer = LLVMCreateMemoryBufferWithMemoryRangeCopy((const char*)object, size,
                                                                         "pleuel");
  return !failed(LLVMOrcLLJITAddObjectFile(jit, library, buffer), message, room, "object");
}

static void* load(const unsigned char* object, size_t size, const pl_prog* const* progs, int n,
                  pl_prog_run** run, char* message, size_t room) {
  initialise();
  LLVMOrcLLJITRef jit = NULL;
  if (failed(LLVMOrcCreateLLJIT(&jit, LLVMOrcCreateLLJITBuilder()), message, room, "loader"))
    return NULL;
  bool fine = link_object(jit, object, size, message, room);
  for (int i = 0; fine && i < n; i++) {
    LLVMOrcExecutorAddress address = 0;
    fine = !failed(LLVMOrcLLJITLookup(jit, &address, progs[i]->name), message, room, "symbol");
    if (fine) run[i] = (pl_prog_run*)(uintptr_t)address;
  }
  if (fine) return jit;
  LLVMErrorRef error = LLVMOrcDisposeLLJIT(jit);
  if (error) LLVMConsumeError(error);
  return NULL;
}

static void unload(void* loaded) {
  LLVMErrorRef error = LLVMOrcDisposeLLJIT(loaded);
  if (error) LLVMConsumeError(error);
}

// --------------------------------------------------------------------------- what the library sees
const pl_plugin* pl_jit_plugin_4(void);
__attribute__((visibility("default"))) const pl_plugin* pl_jit_plugin_4(void) {
  static const pl_plugin plugin = {PL_PLUGIN_VERSION, describe, compile, release, load, unload};
  return &plugin;
}
