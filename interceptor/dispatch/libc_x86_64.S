// The exported dlsym and dlopen. libc's own find out by their return address who is asking (RTLD_NEXT and the
// search path depend on it), so what is not ours to answer is passed on by a jump, with the caller's return address
// still on the stack. dlvsym is not hooked: no GL library gives its symbols versions.

// Asks `lookup`(first argument, second argument, caller), which returns a LibcAnswer.
        .macro  hook name, lookup
        .globl  \name
        .type   \name, @function
\name:
        .cfi_startproc
        endbr64
        pushq   %rdi
        .cfi_adjust_cfa_offset 8
        pushq   %rsi
        .cfi_adjust_cfa_offset 8
        subq    $8, %rsp                # calls are made with the stack on 16 bytes
        .cfi_adjust_cfa_offset 8
        movq    24(%rsp), %rdx          # the caller
        call    \lookup
        addq    $8, %rsp
        .cfi_adjust_cfa_offset -8
        popq    %rsi
        .cfi_adjust_cfa_offset -8
        popq    %rdi
        .cfi_adjust_cfa_offset -8
        testq   %rdx, %rdx              # answered?
        jz      1f
        ret
1:      jmp     *%rax                   # libc's
        .cfi_endproc
        .size   \name, .-\name
        .endm

        .text
        hook    dlsym, shadestepDlsym
        hook    dlopen, shadestepDlopen
        .section .note.GNU-stack, "", @progbits
