// Which sanitizer this is compiled with, for code that allows for it: g++ and clang say so
// differently.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define GIVEWAY_ADDRESS_SANITIZER
#endif
#if __has_feature(thread_sanitizer)
#define GIVEWAY_THREAD_SANITIZER
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
#define GIVEWAY_ADDRESS_SANITIZER
#endif
#ifdef __SANITIZE_THREAD__
#define GIVEWAY_THREAD_SANITIZER
#endif
