"""System calls of WASI preview 1 by Python's `os`, for a module that sees Python's own files, clock and output."""

import errno
import os
import stat
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, Protocol


class Memory(Protocol):
    """The memory of an instance."""

    def read(self, at: int, count: int) -> bytes:
        """Returns bytes of the memory."""

    def write(self, at: int, data: bytes) -> None:
        """Writes bytes to the memory."""


class Exit(BaseException):
    """The end of an instance, with its exit code."""

    def __init__(self, code: int) -> None:
        super().__init__(code)
        self.code = code


# Error numbers of WASI by the names of Python's.
_ERRORS = {
    "EACCES": 2, "EAGAIN": 6, "EBADF": 8, "EBUSY": 10, "EEXIST": 20, "EFBIG": 22, "EINVAL": 28, "EIO": 29, "EISDIR": 31,
    "ELOOP": 32, "EMFILE": 33, "ENAMETOOLONG": 37, "ENOENT": 44, "ENOMEM": 48, "ENOSPC": 51, "ENOSYS": 52, "ENOTDIR": 54,
    "ENOTEMPTY": 55, "EPERM": 63, "EPIPE": 64, "EROFS": 69, "ESPIPE": 70, "EXDEV": 75,
}  # fmt: skip
_ERROR_OF = {getattr(errno, name): number for name, number in _ERRORS.items()}
_ROOT = 3
_CHARACTER_DEVICE, _DIRECTORY, _REGULAR_FILE, _SYMBOLIC_LINK = 2, 3, 4, 7
_ALL_RIGHTS = (1 << 29) - 1
_READ_RIGHT, _WRITE_RIGHT = 1 << 1, 1 << 6


@dataclass
class _Descriptor:
    """An open file or folder. A folder has no number of the operating system."""

    path: str
    number: int | None = None
    append: bool = False
    listing: list[tuple[str, int]] = field(default_factory=list)


class System:
    """The system calls, as methods with their names. Each returns an error number, 0 if there is none."""

    def __init__(self) -> None:
        self.memory: Memory
        self._open = {number: _Descriptor("", number) for number in range(3)} | {_ROOT: _Descriptor("/")}

    def call(self, name: str) -> Callable[..., int | None]:
        """Returns the function for a system call."""
        function = getattr(self, name)

        def answered(*arguments: int) -> int | None:
            try:
                result: int | None = function(*arguments)
                return result or 0
            except OSError as error:
                return _ERROR_OF.get(error.errno or errno.EIO, _ERRORS["EIO"])

        return function if name == "proc_exit" else answered

    def close(self) -> None:
        """Closes all files."""
        for number in [number for number in self._open if number > _ROOT]:
            self.fd_close(number)

    # Addresses and numbers are unsigned; engines pass them as signed.
    def _put(self, at: int, value: int, size: int = 4) -> None:
        self.memory.write(at & 0xFFFFFFFF, value.to_bytes(size, "little"))

    def _text(self, at: int, count: int) -> str:
        return os.fsdecode(self.memory.read(at & 0xFFFFFFFF, count))

    def _entry(self, descriptor: int) -> _Descriptor:
        try:
            return self._open[descriptor]
        except KeyError:
            raise OSError(errno.EBADF, "no such descriptor") from None

    def _path(self, folder: int, at: int, count: int) -> str:
        return os.path.join(self._entry(folder).path, self._text(at, count))

    def _file(self, descriptor: int) -> int:
        number = self._entry(descriptor).number
        if number is None:
            raise OSError(errno.EISDIR, "a folder")
        return number

    def _parts(self, vectors: int, count: int) -> Iterator[tuple[int, int]]:
        table = self.memory.read(vectors & 0xFFFFFFFF, 8 * count)
        for at in range(0, 8 * count, 8):
            yield int.from_bytes(table[at : at + 4], "little"), int.from_bytes(table[at + 4 : at + 8], "little")

    # Arguments, environment, time. The engines provide the clock.

    def args_sizes_get(self, count: int, size: int) -> None:
        self._put(count, 0)
        self._put(size, 0)

    def args_get(self, _table: int, _buffer: int) -> None:
        pass

    @staticmethod
    def _environment() -> list[bytes]:
        return [os.fsencode(f"{name}={value}") + b"\0" for name, value in os.environ.items()]

    def environ_sizes_get(self, count: int, size: int) -> None:
        variables = self._environment()
        self._put(count, len(variables))
        self._put(size, sum(map(len, variables)))

    def environ_get(self, table: int, buffer: int) -> None:
        for k, variable in enumerate(self._environment()):
            self._put(table + 4 * k, buffer & 0xFFFFFFFF)
            self.memory.write(buffer & 0xFFFFFFFF, variable)
            buffer += len(variable)

    def random_get(self, at: int, count: int) -> None:
        self.memory.write(at & 0xFFFFFFFF, os.urandom(count))

    def sched_yield(self) -> None:
        time.sleep(0)

    def poll_oneoff(self, subscriptions: int, events: int, _count: int, happened: int) -> None:
        # Of the only kind that is used: sleep for a time.
        subscription = self.memory.read(subscriptions & 0xFFFFFFFF, 48)
        time.sleep(int.from_bytes(subscription[24:32], "little") / 1e9)
        self.memory.write(events & 0xFFFFFFFF, subscription[:8] + bytes(24))
        self._put(happened, 1)

    def proc_exit(self, code: int) -> None:
        raise Exit(code)

    # Open files.

    def fd_close(self, descriptor: int) -> None:
        number = self._entry(descriptor).number
        del self._open[descriptor]
        if number is not None:
            os.close(number)

    def fd_read(self, descriptor: int, vectors: int, count: int, total: int) -> None:
        number, read = self._file(descriptor), 0
        for at, size in self._parts(vectors, count):
            data = os.read(number, size)
            self.memory.write(at, data)
            read += len(data)
            if len(data) < size:
                break
        self._put(total, read)

    def fd_write(self, descriptor: int, vectors: int, count: int, total: int) -> None:
        data = b"".join(self.memory.read(at, size) for at, size in self._parts(vectors, count))
        entry = self._entry(descriptor)
        if descriptor in (1, 2):
            _print(sys.stdout if descriptor == 1 else sys.stderr, data)
        else:
            number = self._file(descriptor)
            if entry.append:
                os.lseek(number, 0, os.SEEK_END)
            data = data[: os.write(number, data)]
        self._put(total, len(data))

    def fd_seek(self, descriptor: int, offset: int, whence: int, at: int) -> None:
        self._put(at, os.lseek(self._file(descriptor), offset, whence), 8)

    def fd_fdstat_get(self, descriptor: int, at: int) -> None:
        entry = self._entry(descriptor)
        kind = _DIRECTORY if entry.number is None else _kind(os.fstat(entry.number))
        flags = int(entry.append)
        rights = _ALL_RIGHTS.to_bytes(8, "little")
        self.memory.write(at & 0xFFFFFFFF, bytes([kind, 0, flags, 0, 0, 0, 0, 0]) + rights + rights)

    def fd_fdstat_set_flags(self, descriptor: int, flags: int) -> None:
        self._entry(descriptor).append = bool(flags & 1)

    def fd_filestat_get(self, descriptor: int, at: int) -> None:
        entry = self._entry(descriptor)
        self._put_status(at, os.stat(entry.path) if entry.number is None else os.fstat(entry.number))

    def fd_filestat_set_size(self, descriptor: int, size: int) -> None:
        os.ftruncate(self._file(descriptor), size)

    def fd_sync(self, descriptor: int) -> None:
        os.fsync(self._file(descriptor))

    def fd_prestat_get(self, descriptor: int, at: int) -> None:
        if descriptor != _ROOT:
            raise OSError(errno.EBADF, "not the root folder")
        self.memory.write(at & 0xFFFFFFFF, bytes([0, 0, 0, 0, 1, 0, 0, 0]))

    def fd_prestat_dir_name(self, _descriptor: int, at: int, _size: int) -> None:
        self.memory.write(at & 0xFFFFFFFF, b"/")

    def fd_readdir(self, descriptor: int, buffer: int, size: int, cookie: int, used: int) -> None:
        entry = self._entry(descriptor)
        if cookie == 0:
            with os.scandir(entry.path) as found:
                entry.listing = [(each.name, _DIRECTORY if each.is_dir(follow_symlinks=False) else _SYMBOLIC_LINK if each.is_symlink() else _REGULAR_FILE) for each in found]
        data = bytearray()
        for k, (name, kind) in enumerate(entry.listing[cookie:], cookie + 1):
            text = os.fsencode(name)
            data += k.to_bytes(8, "little") + bytes(8) + len(text).to_bytes(4, "little") + bytes([kind, 0, 0, 0]) + text
            if len(data) >= size:
                break
        self.memory.write(buffer & 0xFFFFFFFF, bytes(data[:size]))
        self._put(used, min(len(data), size))

    def _put_status(self, at: int, found: os.stat_result) -> None:
        numbers = [found.st_dev, found.st_ino, _kind(found), found.st_nlink, found.st_size]
        numbers += [found.st_atime_ns, found.st_mtime_ns, found.st_ctime_ns]
        self.memory.write(at & 0xFFFFFFFF, b"".join((number & (2**64 - 1)).to_bytes(8, "little") for number in numbers))

    # Paths.

    def path_open(
        self, folder: int, follow: int, at: int, count: int, creation: int, rights: int, _inherited: int, flags: int, opened: int
    ) -> None:
        path = self._path(folder, at, count)
        create, is_folder, exclusive, truncate = (bool(creation & 1 << bit) for bit in range(4))
        entry = _Descriptor(path, append=bool(flags & 1))
        if is_folder or (os.path.isdir(path) and not create):
            if not stat.S_ISDIR(os.stat(path).st_mode):
                raise OSError(errno.ENOTDIR, "not a folder")
        else:
            reads, writes = bool(rights & _READ_RIGHT), bool(rights & _WRITE_RIGHT)
            mode = os.O_RDWR if reads and writes else os.O_WRONLY if writes else os.O_RDONLY
            mode |= (create and os.O_CREAT) | (exclusive and os.O_EXCL) | (truncate and os.O_TRUNC)
            mode |= getattr(os, "O_BINARY", 0) | (0 if follow & 1 else getattr(os, "O_NOFOLLOW", 0))
            entry.number = os.open(path, mode, 0o666)
        number = next(number for number in range(_ROOT + 1, 2**31) if number not in self._open)
        self._open[number] = entry
        self._put(opened, number)

    def path_filestat_get(self, folder: int, follow: int, at: int, count: int, status: int) -> None:
        self._put_status(status, os.stat(self._path(folder, at, count), follow_symlinks=bool(follow & 1)))

    def path_create_directory(self, folder: int, at: int, count: int) -> None:
        os.mkdir(self._path(folder, at, count))

    def path_remove_directory(self, folder: int, at: int, count: int) -> None:
        os.rmdir(self._path(folder, at, count))

    def path_unlink_file(self, folder: int, at: int, count: int) -> None:
        os.unlink(self._path(folder, at, count))

    def path_rename(self, folder: int, at: int, count: int, target_folder: int, target: int, target_count: int) -> None:
        os.replace(self._path(folder, at, count), self._path(target_folder, target, target_count))

    def path_link(self, folder: int, _follow: int, at: int, count: int, target_folder: int, target: int, target_count: int) -> None:
        os.link(self._path(folder, at, count), self._path(target_folder, target, target_count))

    def path_readlink(self, folder: int, at: int, count: int, buffer: int, size: int, used: int) -> None:
        target = os.fsencode(os.readlink(self._path(folder, at, count)))[:size]
        self.memory.write(buffer & 0xFFFFFFFF, target)
        self._put(used, len(target))


def _kind(found: os.stat_result) -> int:
    if stat.S_ISDIR(found.st_mode):
        return _DIRECTORY
    if stat.S_ISLNK(found.st_mode):
        return _SYMBOLIC_LINK
    return _REGULAR_FILE if stat.S_ISREG(found.st_mode) else _CHARACTER_DEVICE if stat.S_ISCHR(found.st_mode) else 0


def _print(stream: Any, data: bytes) -> None:
    """Writes to a stream, which in a notebook has no bytes."""
    if stream is None:
        return
    raw = getattr(stream, "buffer", None)
    stream.flush()
    if raw is None:
        stream.write(data.decode(errors="replace"))
    else:
        raw.write(data)
    stream.flush()
