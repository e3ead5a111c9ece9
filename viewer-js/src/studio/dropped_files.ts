// The files of what is dropped: of folders those in them, too.

/** Asked at once: after the drop the browser forgets what it was. */
export function droppedFiles(transfer: DataTransfer | null): Promise<File[]> {
  const items = Array.from(transfer?.items ?? []).filter(({ kind }) => kind === "file");
  const found = items.map((item) => ({ entry: item.webkitGetAsEntry(), file: item.getAsFile() }));
  return Promise.all(found.map(({ entry, file }) => (entry?.isDirectory ? within(entry) : file ? [file] : []))).then((all) => all.flat());
}

async function within(entry: FileSystemEntry): Promise<File[]> {
  if (entry.name.startsWith(".")) return []; // what systems leave in folders, and nobody sees
  if (entry.isFile) return [await new Promise<File>((done, fail) => (entry as FileSystemFileEntry).file(done, fail))];
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const all: File[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((done, fail) => reader.readEntries(done, fail)); // a hundred at a time
    if (!some.length) return all;
    for (const one of some) all.push(...(await within(one)));
  }
}
