// A library opened at run time.
#pragma once

#include <dlfcn.h>

#include <string>

namespace fontana {

class SharedLibrary {
 public:
    explicit SharedLibrary(const std::string& path) : handle_(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
        if (handle_) return;
        const char* message = dlerror();
        reason_ = message ? message : "no reason given";
    }
    ~SharedLibrary() {
        if (handle_) dlclose(handle_);
    }
    SharedLibrary(const SharedLibrary&) = delete;
    SharedLibrary& operator=(const SharedLibrary&) = delete;

    bool is_open() const { return handle_ != nullptr; }
    const std::string& reason() const { return reason_; }  // why it is not

    // Null, and false, where there is no such function.
    template <typename Function>
    bool find(const char* symbol, Function*& function) {
        function = reinterpret_cast<Function*>(dlsym(handle_, symbol));
        return function != nullptr;
    }

    // For the life of the process: drivers have threads that do not survive being unloaded.
    void keep_open() { handle_ = nullptr; }

 private:
    void* handle_;
    std::string reason_;
};

}  // namespace fontana
