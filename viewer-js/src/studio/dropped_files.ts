// The files of what is dropped, those of each folder by themselves: what lies beside a motion is for it alone.

/** Asked at once: after the drop the browser forgets what it was. */
export function droppedFiles(transfer: DataTransfer | null): Promise<File[][]> {
  const items = Array.from(transfer?.items ?? []).filter(({ kind }) => kind === "file");
  const found = items.map((item) => ({ entry: item.webkitGetAsEntry(), file: item.getAsFile() }));
  const loose = found.flatMap(({ entry, file }) => (entry?.isDirectory || !file ? [] : [file]));
  const folders = found.flatMap(({ entry }) => (entry?.isDirectory ? [within(entry as FileSystemDirectoryEntry)] : []));
  return Promise.all(folders).then((all) => [loose, ...all.flat()].filter((one) => one.length));
}

async function within(folder: FileSystemDirectoryEntry): Promise<File[][]> {
  if (folder.name.startsWith(".")) return []; // what systems leave in folders, and nobody sees
  const [own, deeper]: [File[], File[][]] = [[], []];
  const reader = folder.createReader();
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((done, fail) => reader.readEntries(done, fail)); // a hundred at a time
    if (!some.length) return [own, ...deeper].filter((one) => one.length);
    for (const one of some) {
      if (one.name.startsWith(".")) continue;
      if (one.isDirectory) deeper.push(...(await within(one as FileSystemDirectoryEntry)));
      else own.push(await new Promise<File>((done, fail) => (one as FileSystemFileEntry).file(done, fail)));
    }
  }
}
